#include "meshgrain/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "util/edge_of.h"
#include "util/hash.h"

namespace meshgrain {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A hash set of undirected edges.
class EdgeSet {
 public:
  explicit EdgeSet(std::size_t capacity) : table_(std::bit_ceil(2 * capacity + 1), empty) {}

  void insert(Index a, Index b) { table_[find(a, b)] = key(a, b); }
  bool contains(Index a, Index b) const { return table_[find(a, b)] != empty; }

 private:
  static constexpr std::uint64_t empty = ~std::uint64_t{0};
  static std::uint64_t key(Index a, Index b) { return key_of(edge_of(a, b)); }
  std::size_t find(Index a, Index b) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash64(key(a, b)) & mask;
    while (table_[slot] != empty && table_[slot] != key(a, b)) slot = (slot + 1) & mask;
    return slot;
  }
  std::vector<std::uint64_t> table_;
};

using Triangle = std::array<Index, 3>;

/// Appends the two triangles of a quad.
void split_quad(std::span<const Vec3> positions, std::span<const Index> face, EdgeSet& edges,
                std::vector<Triangle>& triangles) {
  const auto normal = [&](int a, int b, int c) -> Vector3d {
    const Vector3d p = positions[face[a]].cast<double>();
    return (positions[face[b]].cast<double>() - p).cross(positions[face[c]].cast<double>() - p);
  };
  // Topology before shape: a repeated edge cannot be mended by moving vertices, a fold can.
  const auto badness = [&](int a) {
    const int b = a + 1, c = a + 2, d = (a + 3) % 4;
    return std::tuple(edges.contains(face[a], face[c]), normal(a, b, c).dot(normal(a, c, d)) <= 0,
                      (positions[face[a]] - positions[face[c]]).squaredNorm());
  };
  const std::size_t a = badness(0) <= badness(1) ? 0 : 1;
  triangles.push_back({face[a], face[a + 1], face[a + 2]});
  triangles.push_back({face[a], face[a + 2], face[(a + 3) % 4]});
  edges.insert(face[a], face[a + 2]);
}

/// Clips the ears of one polygon.
class EarClipper {
 public:
  EarClipper(std::span<const Vec3> positions, std::span<const Index> face, EdgeSet& edges)
      : face_(face), edges_(edges), size_(face.size()), corners_(face.size()) {
    project(positions);
    const std::uint32_t n = static_cast<std::uint32_t>(size_);
    for (std::uint32_t i = 0; i < n; ++i) {
      corners_[i].previous = (i + n - 1) % n;
      corners_[i].next = (i + 1) % n;
    }
    for (std::uint32_t i = 0; i < n; ++i)
      if (turn(i) <= 0) {
        corners_[i].reflex = true;
        reflex_.push_back(i);
      }
  }

  void run(std::vector<Triangle>& triangles) {
    while (size_ > 3) {
      // Each pass gives up more: that an ear is one (a fold can be mended), then that its diagonal
      // is new. A pass that found something starts again from the first.
      if (!pass(true, true, triangles) && !pass(false, true, triangles))
        pass(false, false, triangles);
    }
    std::uint32_t i = 0;
    while (corners_[i].gone) ++i;
    triangles.push_back(triangle(i));
  }

 private:
  struct Corner {
    Vector2d place = Vector2d::Zero();  // in the mean plane
    std::uint32_t previous = 0, next = 0;
    std::uint32_t version = 0;  // counts changes of its neighbours
    bool reflex = false;
    bool gone = false;
  };
  static constexpr std::size_t patience = 100000;  // corners looked at again
  struct Ear {
    double length;
    std::uint32_t corner, version;
    bool operator>(const Ear& other) const {
      return std::tie(length, corner) > std::tie(other.length, other.corner);
    }
  };

  void project(std::span<const Vec3> positions) {
    const Vector3d base = positions[face_[0]].cast<double>();
    Vector3d area = Vector3d::Zero();  // Newell's normal
    for (std::size_t i = 0; i < size_; ++i)
      area += (positions[face_[i]].cast<double>() - base)
                  .cross(positions[face_[(i + 1) % size_]].cast<double>() - base);
    const Vector3d n = area.norm() > 0 ? Vector3d(area.normalized()) : Vector3d(Vector3d::UnitZ());
    const Vector3d u = n.unitOrthogonal(), v = n.cross(u);
    for (std::size_t i = 0; i < size_; ++i) {
      const Vector3d d = positions[face_[i]].cast<double>() - base;
      corners_[i].place = {u.dot(d), v.dot(d)};
    }
  }

  static double cross(const Vector2d& a, const Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  }

  /// Twice the signed area of the triangle of a corner and its neighbours.
  double turn(std::uint32_t i) const {
    const Corner& c = corners_[i];
    return cross(c.place - corners_[c.previous].place, corners_[c.next].place - c.place);
  }

  Triangle triangle(std::uint32_t i) const {
    return {face_[corners_[i].previous], face_[i], face_[corners_[i].next]};
  }

  /// Whether the corner is convex with no other in its triangle; only reflex ones can be the first.
  bool is_ear(std::uint32_t i) const {
    if (turn(i) <= 0) return false;
    const Corner& c = corners_[i];
    const Vector2d &a = corners_[c.previous].place, &b = c.place, &d = corners_[c.next].place;
    const Vector2d low = a.cwiseMin(b).cwiseMin(d), high = a.cwiseMax(b).cwiseMax(d);
    return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t r) {
      const Vector2d& p = corners_[r].place;
      if (p.x() < low.x() || p.x() > high.x() || p.y() < low.y() || p.y() > high.y()) return false;
      if (!corners_[r].reflex || r == c.previous || r == c.next || p == a || p == b || p == d)
        return false;
      return cross(b - a, p - a) >= 0 && cross(d - b, p - b) >= 0 && cross(a - d, p - d) >= 0;
    });
  }

  void clip(std::uint32_t i, std::vector<Triangle>& triangles) {
    triangles.push_back(triangle(i));
    Corner& c = corners_[i];
    edges_.insert(face_[c.previous], face_[c.next]);
    corners_[c.previous].next = c.next;
    corners_[c.next].previous = c.previous;
    c.gone = true;
    c.reflex = false;
    --size_;
    for (const std::uint32_t end : {c.previous, c.next}) {
      ++corners_[end].version;
      // A fold may make a corner reflex that was none; what matters then is new edges, not ears.
      corners_[end].reflex = corners_[end].reflex && turn(end) <= 0;
    }
    if (++clipped_ * 2 > reflex_.size()) {
      std::erase_if(reflex_, [&](std::uint32_t r) { return !corners_[r].reflex; });
      clipped_ = 0;
    }
  }

  bool is_old(Index a, Index b) const { return a == b || edges_.contains(a, b); }

  /// Clips all ears it finds if `ears`, else one corner, after which there may be ears again; of a
  /// polygon that has often had none all. Returns whether there was any.
  bool pass(bool ears, bool new_edges, std::vector<Triangle>& triangles) {
    std::priority_queue<Ear, std::vector<Ear>, std::greater<>> queue;
    const auto offer = [&](std::uint32_t i) {
      const Corner& c = corners_[i];
      if (ears && turn(i) <= 0) return;
      queue.push({(corners_[c.next].place - corners_[c.previous].place).norm(), i, c.version});
    };
    for (std::uint32_t i = 0; i < corners_.size(); ++i)
      if (!corners_[i].gone) offer(i);
    bool any = false;
    while (!queue.empty() && size_ > 3) {
      const Ear ear = queue.top();
      queue.pop();
      const Corner& c = corners_[ear.corner];
      if (c.gone || c.version != ear.version) continue;
      if (new_edges && is_old(face_[c.previous], face_[c.next])) continue;
      if (ears && !is_ear(ear.corner)) continue;
      clip(ear.corner, triangles);
      any = true;
      if (!ears && ++forced_ * corners_.size() < patience) break;
      offer(c.previous);
      offer(c.next);
    }
    return any;
  }

  std::span<const Index> face_;
  EdgeSet& edges_;
  std::size_t size_;  // corners that are left
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> reflex_;  // all reflex corners, and some that no longer are
  std::size_t clipped_ = 0;            // corners since the list was cleared of those
  std::size_t forced_ = 0;             // corners clipped that were no ears
};

}  // namespace

Mesh triangulate(const Mesh& polygons, std::vector<Index>* face_of_triangle) {
  const Faces& faces = polygons.faces;
  // At most as many edges as corners and fewer diagonals; half of that where edges are shared.
  const bool diagonals = faces.uniform_degree() != 3;
  EdgeSet edges(diagonals ? faces.corners().size() * 3 / 2 : 0);
  std::size_t count = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::span<const Index> face = faces[f];
    if (face.size() >= 3) count += face.size() - 2;
    if (diagonals)
      for (std::size_t i = 0; i < face.size(); ++i)
        edges.insert(face[i], face[(i + 1) % face.size()]);
  }

  Mesh result;
  result.positions = polygons.positions;
  result.normals = polygons.normals;
  result.values = polygons.values;
  result.marked_edges = polygons.marked_edges;
  result.origin = polygons.origin;
  result.faces = Faces::uniform(count, 3);
  if (face_of_triangle) face_of_triangle->clear();
  std::vector<Triangle> triangles;
  std::size_t at = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::span<const Index> face = faces[f];
    triangles.clear();
    if (face.size() == 3)
      triangles.push_back({face[0], face[1], face[2]});
    else if (face.size() == 4)
      split_quad(polygons.positions, face, edges, triangles);
    else if (face.size() > 4)
      EarClipper(polygons.positions, face, edges).run(triangles);
    std::erase_if(triangles, [](const Triangle& t) {  // of a polygon that repeats a vertex
      return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    });
    for (const Triangle& t : triangles) std::copy(t.begin(), t.end(), result.faces[at++].begin());
    if (face_of_triangle)
      face_of_triangle->insert(face_of_triangle->end(), triangles.size(), static_cast<Index>(f));
  }
  if (at < count) {
    Faces fewer = Faces::uniform(at, 3);
    std::copy_n(std::as_const(result.faces).corners().begin(), 3 * at, fewer.corners().begin());
    result.faces = std::move(fewer);
  }
  return result;
}

}  // namespace meshgrain
