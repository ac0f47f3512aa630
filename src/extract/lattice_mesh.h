#pragma once

#include <optional>
#include <span>
#include <vector>

#include "extract/clusters.h"
#include "extract/jump_map.h"
#include "extract/lattice_triangle.h"
#include "features/feature_jumps.h"

namespace meshgrain {

/// A coarse triangle mesh that knows where each of its vertices lies in the lattice of its
/// neighbours: the jumps of a position field over the clusters of its lattice points. Where no
/// triangle is singular it is a map of the surface into the plane, with vertices at integers.
class LatticeMesh : public JumpMap {
 public:
  /// `roots`: for each vertex the node in whose frame its jumps are. `keeps_singularities`: see
  /// ExtractOptions.
  LatticeMesh(JumpMap&& shrunk, Clusters&& clusters_of_vertices, std::span<const Index> roots,
              const Graph& graph, const OrientationField& orientation,
              const PositionField& position,
              std::span<const std::uint8_t> keeps_singularities = {});

  Clusters clusters;

  LatticeMetric metric() const { return {posy}; }
  /// The squared length of an edge in the lattice.
  double squared_length(Index h) const { return metric().squared_length(jumps[h / 2].t); }

  /// The triangle left of h, from h's origin on.
  LatticeTriangle triangle(Index h) const {
    return {posy, {jump(h), jump(map.next(h)), jump(map.prev(h))}};
  }
  /// Whether the target edge length varies over that triangle.
  bool is_graded(Index h) const;
  /// Whether it may not become regular.
  bool keeps_singularity(Index h) const;
  /// Whether h has a triangle on its left, and is the halfedge that stands for it.
  bool stands_for_triangle(Index h) const {
    return !map.removed(h) && !holes[h] && h < map.next(h) && h < map.prev(h);
  }

  /// What the jump of h would be if it were the real distance of its ends, as both of them see it.
  LatticePoint real_jump(Index h) const;
  /// How far (squared, in edge lengths) a jump of h would be from the real distance of its ends.
  double misfit(Index h, const std::array<int, 2>& t) const;

  /// The angle in the lattice around a vertex: a full turn where all is well, but for the apex of a
  /// cone.
  double total_angle(Index vertex) const;

  bool may_flip(Index h) const;
  /// Turns the edge of h to the other diagonal of its two triangles, with the jump by way of h's
  /// origin: the triangle there becomes plane, and what the two held is in the other.
  void flip(Index h);
  /// The jump that flip(h) gives, from the apex on the side of h.
  Jump flipped_jump(Index h) const;

  /// Whether that is a triangle mesh still, and nothing has to reach far: a finger of the surface
  /// must not vanish vertex by vertex.
  bool may_collapse(Index h);
  /// The target of h vanishes.
  void collapse_edge(Index h);

  /// A new vertex on the edge of h, at `t` from its origin.
  void split(Index h, const std::array<int, 2>& t);
  /// A new vertex in the triangle left of h, at `t` from h's origin. `to_apex` is the jump from
  /// there to the corner opposite of h.
  void insert(Index h, const std::array<int, 2>& t, const Jump& to_apex);

  /// Whether a jump of h would leave a feature line that runs along an axis of the lattice, or
  /// change one that stays.
  bool spoils_line(Index h, const std::array<int, 2>& t) const {
    if (!on_feature(h)) return false;
    if (is_kept(h)) return t != jump(h).t;
    return is_along_axis(jumps[h / 2].t, posy) && !is_along_axis(t, posy);
  }

  /// Whether shift() would do that to a line.
  bool shift_spoils_lines(Index vertex, const std::array<int, 2>& t) const;
  /// Moves a vertex by a lattice vector: only the numbers change.
  void shift(Index vertex, const std::array<int, 2>& t);

 private:
  /// How far the origin of h would stand, in edge lengths, from the farthest vertex that went into
  /// it, if the target did too.
  float reach_with_target(Index h) const;
  LatticePoint coordinates(const Vec3& d, Index vertex) const;
  void add_vertex(Index like, const Vec3& position, bool on_border, Hold held);
  void add_edge(Index from, Index to, const Jump& jump);

  std::vector<Vec3> directions_;
  std::vector<float> lengths_;
  std::vector<std::uint8_t> keeps_singularities_;  // or empty
  std::vector<float> reach_;                       // of each vertex: see reach_with_target()
  LinkCondition link_;
};

}  // namespace meshgrain
