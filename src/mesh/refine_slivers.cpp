#include "mesh/refine_slivers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/border.h"
#include "mesh/midpoint.h"
#include "util/edge_of.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

using Vec3d = Eigen::Vector3d;

/// How many vertices subdivide() makes of a face if that is a sliver, else 0.
double vertices_of_sliver(const Mesh& mesh, std::size_t f, double limit) {
  const auto face = mesh.faces[f];
  const Vec3d a = mesh.positions[face[0]].cast<double>(),
              b = mesh.positions[face[1]].cast<double>(),
              c = mesh.positions[face[2]].cast<double>();
  const std::array<double, 3> sides{(b - a).norm(), (c - b).norm(), (a - c).norm()};
  const double longest = std::ranges::max(sides);
  constexpr double thin = 6;  // times as long as wide
  if (longest <= limit || longest * longest < thin * (b - a).cross(c - a).norm()) return 0;
  double sum = 0;
  for (const double side : sides) sum += (std::max(std::ceil(side / limit), 1.0) - 1) / 2;
  return sum;
}

/// The triangles of a mesh, with those across their edges, so that edges can be split and turned.
class Refinement {
 public:
  Refinement(Mesh& mesh, double limit, const Context& context);

  void run(const Context& context);
  /// Gives the mesh what has become of its triangles and marks.
  void put_back();

 private:
  /// Edge k goes from corner k to the next one.
  struct Triangle {
    std::array<Index, 3> corners;
    std::array<Index, 3> across;  // of each edge: 3 t + k of the other side, or no_index
  };
  Index corner(Index h) const { return triangles_[h / 3].corners[h % 3]; }
  Index across(Index h) const { return triangles_[h / 3].across[h % 3]; }
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index last(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  Vec3d point(Index v) const { return mesh_.positions[v].cast<double>(); }
  float squared_length(Index h) const {
    return (mesh_.positions[corner(next(h))] - mesh_.positions[corner(h)]).squaredNorm();
  }

  void connect(const Context& context);
  /// The side of a triangle from vertex `from` on.
  Index side(Index triangle, Index from) const {
    const auto& corners = triangles_[triangle].corners;
    return 3 * triangle + (corners[0] == from ? 0 : corners[1] == from ? 1 : 2);
  }
  void link(Index h, Index other) {
    triangles_[h / 3].across[h % 3] = other;
    if (other != no_index) triangles_[other / 3].across[other % 3] = h;
  }
  void push_if_long(Index h);
  Index midpoint(Index h);
  void split(Index h);
  void turn_edges();
  bool should_turn(Index h);
  bool are_joined(Index g, Index h);
  bool is_edge(Index a, Index b);
  void count_sides(Index triangle, int change);
  /// To be called with -1 before triangles change, and with 1 after.
  void change_sides(std::initializer_list<Index> triangles, int change) {
    if (sides_.empty()) return;
    for (const Index t : triangles) count_sides(t, change);
  }
  void turn(Index h);

  struct LongEdge {
    float squared_length;
    Index h, from, to;  // where it was: it may have gone since
    bool operator<(const LongEdge& o) const {
      return std::tie(squared_length, o.h) < std::tie(o.squared_length, h);
    }
  };

  Mesh& mesh_;
  const double limit_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> at_rim_;  // of each vertex: at an edge not between two triangles
  std::set<std::array<Index, 2>> marked_;
  std::map<std::array<Index, 2>, Index> midpoints_;  // of edges that are not between two triangles
  std::priority_queue<LongEdge> queue_;
  std::vector<Index> to_check_;  // edges that may not be Delaunay
  // How many triangles have an edge between two vertices; empty until somebody asks.
  std::unordered_map<std::uint64_t, int> sides_;
  std::size_t most_turns_ = 0;
};

Refinement::Refinement(Mesh& mesh, double limit, const Context& context)
    : mesh_(mesh), limit_(limit) {
  triangles_.reserve(2 * mesh.faces.size());
  at_rim_.assign(mesh.positions.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    triangles_.push_back({{face[0], face[1], face[2]}, {no_index, no_index, no_index}});
  }
  connect(context);
  for (const auto& [a, b] : mesh.marked_edges) marked_.insert(edge_of(a, b));
  for (Index h = 0; h < 3 * triangles_.size(); ++h) {
    push_if_long(h);
    if (squared_length(h) > limit * limit) to_check_.push_back(h);
  }
}

/// Links the two sides of every edge that lies between two triangles of the same orientation.
void Refinement::connect(const Context& context) {
  const auto all = [](const InnerEdge&) { return true; };
  for (const auto& [ends, left, right] : inner_edges(mesh_, all, context)) {
    link(side(left, ends[0]), side(right, ends[1]));
  }
  for (const auto& [a, b] : rim_edges(mesh_, context)) at_rim_[a] = at_rim_[b] = 1;
}

void Refinement::push_if_long(Index h) {
  const float length = squared_length(h);
  if (!(length > limit_ * limit_)) return;
  queue_.push({length, h, corner(h), corner(next(h))});
}

void Refinement::run(const Context& context) {
  // Turning cannot go round in circles in a plane; on what is only nearly one it might.
  constexpr std::size_t turns_an_edge = 20;
  constexpr std::size_t most_triangles = no_index / 3 - 2;  // what is left, subdivide() refuses
  most_turns_ = turns_an_edge * to_check_.size();
  turn_edges();
  for (std::size_t done = 0; !queue_.empty(); ++done) {
    if (done % 4096 == 0) context.check();
    if (triangles_.size() > most_triangles) return;
    const LongEdge edge = queue_.top();
    queue_.pop();
    if (corner(edge.h) != edge.from || corner(next(edge.h)) != edge.to) continue;
    split(edge.h);
    most_turns_ += turns_an_edge;
    turn_edges();
  }
}

/// The same vertex for all triangles at an edge, if they do not know of each other.
Index Refinement::midpoint(Index h) {
  const Index a = corner(h), b = corner(next(h));
  const auto added = static_cast<Index>(mesh_.positions.size());
  if (across(h) == no_index) {
    const auto [known, is_new] = midpoints_.try_emplace(edge_of(a, b), added);
    if (!is_new) return known->second;
  }
  append_midpoint(mesh_, a, b);
  if (marked_.erase(edge_of(a, b)) > 0) {
    marked_.insert(edge_of(a, added));
    marked_.insert(edge_of(added, b));
  }
  at_rim_.push_back(across(h) == no_index);
  return added;
}

void Refinement::split(Index h) {
  const Index other = across(h);
  const Index m = midpoint(h);
  // Each side keeps the half at the origin of its halfedge; a new triangle gets the other one.
  const auto halve = [&](Index side) {
    const Index b = corner(next(side)), apex = corner(last(side));
    const auto added = static_cast<Index>(3 * triangles_.size());
    change_sides({side / 3}, -1);
    triangles_.push_back({{m, b, apex}, {no_index, no_index, no_index}});
    link(added + 1, across(next(side)));
    triangles_[side / 3].corners[next(side) % 3] = m;
    change_sides({side / 3, added / 3}, 1);
    link(next(side), added + 2);
    for (const Index g : {side, added, added + 1, added + 2}) push_if_long(g);
    for (const Index opposite : {last(side), added + 1}) to_check_.push_back(opposite);
    return added;
  };
  const Index rest = halve(h);
  if (other != no_index) {
    const Index other_rest = halve(other);
    link(h, other_rest);
    link(rest, other);
  } else {
    link(h, no_index);
  }
}

void Refinement::turn_edges() {
  while (!to_check_.empty()) {
    const Index h = to_check_.back();
    to_check_.pop_back();
    if (most_turns_ == 0 || !should_turn(h)) continue;
    --most_turns_;
    turn(h);
  }
}

/// Whether the other diagonal is Delaunay, and nearly in the place of this one.
bool Refinement::should_turn(Index h) {
  const Index other = across(h);
  if (other == no_index) return false;
  const Index a = corner(h), b = corner(next(h)), c = corner(last(h)), d = corner(last(other));
  if (c == d || marked_.contains(edge_of(a, b))) return false;
  const Vec3d pa = point(a), pb = point(b), pc = point(c), pd = point(d);
  const Vec3d left = (pb - pa).cross(pc - pa), right = (pd - pa).cross(pb - pa);
  // Opposite angles add up to more than half a turn.
  const double cos_c = (pa - pc).dot(pb - pc), cos_d = (pa - pd).dot(pb - pd);
  const double sin_c = left.norm(), sin_d = right.norm();
  constexpr double slack = 1e-6;
  const double scale = (pa - pc).norm() * (pb - pc).norm() * (pa - pd).norm() * (pb - pd).norm();
  if (!(sin_c * cos_d + cos_c * sin_d < -slack * scale)) return false;
  constexpr double nearly_plane = 0.95;  // the cosine between two normals
  if (left.dot(right) < nearly_plane * sin_c * sin_d) return false;
  const Vec3d up = left + right;
  if ((pd - pa).cross(pc - pa).dot(up) <= 0 || (pb - pd).cross(pc - pd).dot(up) <= 0) return false;
  const Vec3d across_both = (pb - pa).cross(pd - pc);
  constexpr double most_moved = 0.001;  // of the longest edge, at a time
  const double apart = std::abs(across_both.dot(pc - pa));
  return apart <= most_moved * limit_ * across_both.norm() && !are_joined(last(h), last(other));
}

/// Whether an edge joins the origins of two halfedges already, or might where one cannot look. Goes
/// around both at once, as one of them may be the apex of a cone.
bool Refinement::are_joined(Index g, Index h) {
  constexpr int few = 64;  // steps around, which take less time than to look up an edge
  const Index c = corner(g), d = corner(h);
  const bool look_around_c = !at_rim_[c], look_around_d = !at_rim_[d];
  if (!look_around_c && !look_around_d) return true;
  Index from_c = g, from_d = h;
  int steps = 0;
  do {
    if (++steps > few) return is_edge(c, d);
    if (look_around_c) {
      if (corner(next(from_c)) == d) return true;
      from_c = across(last(from_c));
    }
    if (look_around_d) {
      if (corner(next(from_d)) == c) return true;
      from_d = across(last(from_d));
    }
  } while ((!look_around_c || from_c != g) && (!look_around_d || from_d != h));
  return false;
}

bool Refinement::is_edge(Index a, Index b) {
  if (sides_.empty()) {
    sides_.reserve(2 * triangles_.size());
    for (Index t = 0; t < triangles_.size(); ++t) count_sides(t, 1);
  }
  const auto found = sides_.find(key_of(edge_of(a, b)));
  return found != sides_.end() && found->second > 0;
}

void Refinement::count_sides(Index triangle, int change) {
  const auto& [a, b, c] = triangles_[triangle].corners;
  for (const auto& edge : {edge_of(a, b), edge_of(b, c), edge_of(c, a)}) {
    sides_[key_of(edge)] += change;
  }
}

void Refinement::turn(Index h) {
  const Index other = across(h);
  const Index a = corner(h), b = corner(next(h)), c = corner(last(h)), d = corner(last(other));
  const Index bc = across(next(h)), ca = across(last(h)), ad = across(next(other)),
              db = across(last(other));
  const Index t = h / 3, u = other / 3;
  change_sides({t, u}, -1);
  triangles_[t] = {{a, d, c}, {no_index, no_index, no_index}};
  triangles_[u] = {{d, b, c}, {no_index, no_index, no_index}};
  change_sides({t, u}, 1);
  link(3 * t, ad);
  link(3 * t + 1, 3 * u + 2);
  link(3 * t + 2, ca);
  link(3 * u, db);
  link(3 * u + 1, bc);
  push_if_long(3 * t + 1);
  for (const Index g : {3 * t, 3 * t + 2, 3 * u, 3 * u + 1}) {
    push_if_long(g);
    to_check_.push_back(g);
  }
}

void Refinement::put_back() {
  mesh_.faces = Faces::uniform(triangles_.size(), 3);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    std::ranges::copy(triangles_[t].corners, mesh_.faces[t].begin());
  }
  mesh_.marked_edges.assign(marked_.begin(), marked_.end());
}

}  // namespace

bool refine_slivers(Mesh& mesh, double max_length, std::span<const Index> long_faces,
                    const Context& context) {
  constexpr double few = 0.25;  // of the vertices that there are
  const double made = sum_over_ranges(
      long_faces.size(),
      [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t k = begin; k < end; ++k) {
          sum += vertices_of_sliver(mesh, long_faces[k], max_length);
        }
        return sum;
      },
      context);
  if (made <= few * static_cast<double>(mesh.positions.size())) return false;
  Refinement refinement(mesh, max_length, context);
  refinement.run(context);
  refinement.put_back();
  return true;
}

}  // namespace meshgrain
