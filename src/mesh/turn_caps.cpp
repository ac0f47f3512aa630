#include "mesh/turn_caps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/keep_vertices.h"
#include "util/edge_of.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

using Vec3d = Eigen::Vector3d;

/// A cap is no higher than this share of its longest edge. Slivers of tessellations mostly are.
constexpr float flat = 1e-3f;

/// How high a triangle is over its longest edge, as a share of that, how long that is, and where it
/// starts: at corner k, to the next one.
struct Shape {
  double height, squared_length;
  unsigned k;
  bool is_cap;
};

class Caps {
 public:
  explicit Caps(Mesh& mesh) : mesh_(mesh), corners_(mesh.faces.corners()) {}

  std::size_t run(const Context& context);

 private:
  using Corners = std::array<Index, 3>;

  Corners face(Index f) const {
    return {corners_[3 * f], corners_[3 * f + 1], corners_[3 * f + 2]};
  }
  bool is_gone(Index f) const { return corners_[3 * f] == corners_[3 * f + 1]; }
  Shape shape(const Corners& t) const;
  bool may_be_cap(Index f) const;
  static std::uint64_t key(Index a, Index b) { return key_of(edge_of(a, b)); }
  std::span<const Index> beside(Index a, Index b) const {
    const auto found = faces_of_.find(key(a, b));
    return found == faces_of_.end() ? std::span<const Index>() : found->second;
  }
  bool is_known(Index a, Index b) const { return at_cap_[a] || at_cap_[b]; }
  void put(Index f, const Corners& t);
  void take(Index f);

  void note_faces(const std::vector<Index>& caps, const Context& context);
  bool turn(Index f, unsigned k);
  bool drop(Index f, unsigned k);
  void move_marks();

  Mesh& mesh_;
  std::span<Index> corners_;
  std::vector<std::uint8_t> at_cap_;     // vertices all of whose faces are in faces_of_
  std::vector<std::uint8_t> on_border_;  // of those
  std::unordered_map<std::uint64_t, std::vector<Index>> faces_of_;  // edges
  std::unordered_map<std::uint64_t, Index> passes_;  // edges that were turned: through which vertex
};

Shape Caps::shape(const Corners& t) const {
  std::array<Vec3d, 3> p;
  for (unsigned i = 0; i < 3; ++i) p[i] = mesh_.positions[t[i]].cast<double>();
  std::array<double, 3> squares;
  for (unsigned i = 0; i < 3; ++i) squares[i] = (p[(i + 1) % 3] - p[i]).squaredNorm();
  const auto k = static_cast<unsigned>(std::ranges::max_element(squares) - squares.begin());
  const double square = squares[k];
  if (!(square > 0)) return {0, 0, 0, false};
  const Vec3d along = p[(k + 1) % 3] - p[k], apex = p[(k + 2) % 3] - p[k];
  const double height = along.cross(apex).norm() / square, way = along.dot(apex) / square;
  constexpr double away_from_ends = 1e-2;  // slivers of tessellations have a short edge
  return {height, square, k, height < flat && std::min(way, 1 - way) > away_from_ends};
}

void Caps::put(Index f, const Corners& t) {
  for (unsigned i = 0; i < 3; ++i) {
    corners_[3 * f + i] = t[i];
    faces_of_[key(t[i], t[(i + 1) % 3])].push_back(f);
  }
}

void Caps::take(Index f) {
  const Corners t = face(f);
  for (unsigned i = 0; i < 3; ++i) std::erase(faces_of_[key(t[i], t[(i + 1) % 3])], f);
}

void Caps::note_faces(const std::vector<Index>& caps, const Context& context) {
  at_cap_.assign(mesh_.positions.size(), 0);
  for (const Index f : caps) {
    for (const Index v : face(f)) at_cap_[v] = 1;
  }
  const auto is_near = [&](Index f) {
    return std::ranges::any_of(face(f), [&](Index v) { return at_cap_[v] != 0; });
  };
  for (const Index f : indices_where(mesh_.faces.size(), is_near, context)) put(f, face(f));
  on_border_.assign(mesh_.positions.size(), 0);
  for (const auto& [edge, faces] : faces_of_) {
    if (faces.size() == 1) on_border_[edge >> 32] = on_border_[static_cast<Index>(edge)] = 1;
  }
}

bool Caps::turn(Index f, unsigned k) {
  const Corners t = face(f);
  const Index a = t[k], b = t[(k + 1) % 3], apex = t[(k + 2) % 3];
  const auto faces = beside(a, b);
  if (!is_known(a, b) || faces.size() != 2) return false;
  const Index g = faces[0] == f ? faces[1] : faces[0];
  const Corners u = face(g);
  unsigned j = 0;
  while (j < 3 && !(u[j] == b && u[(j + 1) % 3] == a)) ++j;
  if (j == 3) return false;  // they disagree on their side
  const Index beyond = u[(j + 2) % 3];
  if (beyond == apex || !is_known(apex, beyond) || !beside(apex, beyond).empty()) return false;
  const Corners first{apex, a, beyond}, second{beyond, b, apex};
  const Shape before = shape(t), one = shape(first), other = shape(second);
  const bool are_shorter =
      std::max(one.squared_length, other.squared_length) < before.squared_length;
  if (!are_shorter && std::min(one.height, other.height) <= before.height) return false;
  take(f);
  take(g);
  put(f, first);
  put(g, second);
  passes_[key(a, b)] = apex;
  return true;
}

/// A fin, or at the border: the other two edges become border, which the apex is not on so far.
bool Caps::drop(Index f, unsigned k) {
  const Corners t = face(f);
  const Index a = t[k], b = t[(k + 1) % 3], apex = t[(k + 2) % 3];
  const auto is_border = [&](Index v, Index w) { return beside(v, w).size() == 1; };
  const bool is_fin = is_border(b, apex) && is_border(apex, a);
  const bool is_known_apex = at_cap_[apex] != 0;
  if (!is_known_apex || !(is_fin || (is_border(a, b) && !on_border_[apex]))) return false;
  take(f);
  on_border_[apex] = 1;
  corners_[3 * f] = corners_[3 * f + 1];
  return true;
}

void Caps::move_marks() {
  std::vector<std::array<Index, 2>> marks = std::exchange(mesh_.marked_edges, {});
  while (!marks.empty()) {
    const auto [a, b] = marks.back();
    marks.pop_back();
    const auto passes = beside(a, b).empty() ? passes_.find(key(a, b)) : passes_.end();
    if (passes == passes_.end()) {
      mesh_.marked_edges.push_back({a, b});
    } else {
      marks.push_back({a, passes->second});
      marks.push_back({passes->second, b});
    }
  }
  std::ranges::sort(mesh_.marked_edges);
}

/// As good as shape(), for all that are clearly higher.
bool Caps::may_be_cap(Index f) const {
  const Vec3& a = mesh_.positions[corners_[3 * f]];
  const Vec3 b = mesh_.positions[corners_[3 * f + 1]] - a;
  const Vec3 c = mesh_.positions[corners_[3 * f + 2]] - a;
  const float square = std::max({b.squaredNorm(), c.squaredNorm(), (c - b).squaredNorm()});
  constexpr float higher = 2 * flat;
  return b.cross(c).squaredNorm() <= higher * higher * square * square;
}

std::size_t Caps::run(const Context& context) {
  const auto is_cap = [&](Index f) { return may_be_cap(f) && shape(face(f)).is_cap; };
  const std::vector<Index> caps = indices_where(mesh_.faces.size(), is_cap, context);
  if (caps.empty()) return 0;
  note_faces(caps, context);
  // The longest edge first: of those on it that are caps themselves one is beyond the next.
  std::priority_queue<std::pair<double, Index>> open;
  const auto add = [&](Index f) {
    const Shape here = shape(face(f));
    if (here.is_cap) open.push({here.squared_length, f});
  };
  std::ranges::for_each(caps, add);
  std::size_t mended = 0, dropped = 0;
  for (std::size_t left = 16 * caps.size(); left > 0 && !open.empty(); --left) {
    const auto [squared_length, f] = open.top();
    open.pop();
    if (is_gone(f)) continue;
    const Shape here = shape(face(f));
    if (!here.is_cap || here.squared_length != squared_length) continue;
    const auto faces = beside(face(f)[here.k], face(f)[(here.k + 1) % 3]);
    const std::vector<Index> both(faces.begin(), faces.end());
    if (turn(f, here.k)) {
      ++mended;
      std::ranges::for_each(both, add);
    } else if (drop(f, here.k)) {
      ++mended;
      ++dropped;
    }
  }
  if (!mesh_.marked_edges.empty()) move_marks();
  if (dropped > 0) {
    const auto stays = [&](Index f) { return !is_gone(f); };
    const auto kept = indices_where(mesh_.faces.size(), stays, context);
    Faces left = Faces::uniform(kept.size(), 3);
    for (std::size_t i = 0; i < kept.size(); ++i) std::ranges::copy(face(kept[i]), left[i].begin());
    mesh_.faces = std::move(left);
    drop_unused_vertices(mesh_, context);
  }
  return mended;
}

}  // namespace

std::size_t turn_caps(Mesh& triangles, const Context& context) {
  return Caps(triangles).run(context);
}

}  // namespace meshgrain
