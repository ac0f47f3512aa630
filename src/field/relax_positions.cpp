#include "field/relax_positions.h"

#include <array>

#include "field/with_symmetry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/relax_positions.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "field/symmetry_lanes.h"
#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

struct Level {
  const Graph& graph;
  const LatticeFrame& frame;
  const LineConstraints& constraints;
  const Vec3* field;
};

template <int S, PositionEnergy E>
class Relaxation {
 public:
  HWY_INLINE Relaxation(const Level& level, NeighborLanes& around)
      : level_(level),
        around_(around),
        x_(gather(level.graph.positions.data(), around.nodes)),
        lattice_(gather(level.field, around.nodes),
                 gather(level.frame.directions.data(), around.nodes),
                 gather(level.graph.normals.data(), around.nodes),
                 cell_sizes(level.frame.edge_length, around.nodes)) {}

  HWY_INLINE Vec3s run() {
    Vec3s& mean = lattice_.p;  // so far
    Floats total = all(0);
    while (around_.next()) {
      const auto [own, other] = matched();
      const Floats w = around_.weights();
      const Vec3s sum = (total * own + w * other) / (total + w);
      mean = choose(around_.active, project(sum), mean);
      total = choose(around_.active, total + w, total);
    }
    constrain();
    return lattice_.point(lattice_.round(x_));
  }

 private:
  HWY_INLINE Vec3s project(const Vec3s& p) const {
    return p - dot(lattice_.n, p - x_) * lattice_.n;
  }

  /// Points of both lattices that are one: that of the nodes, and that of their neighbours.
  HWY_INLINE std::array<Vec3s, 2> matched() const {
    const Ints& j = around_.neighbors;
    const Vec3s normal = gather(level_.graph.normals.data(), j);
    const Vec3s q =
        intermediate_positions(x_, lattice_.n, gather(level_.graph.positions.data(), j), normal);
    const Vec3s p = gather(level_.field, j);
    if constexpr (E == PositionEnergy::extrinsic) {
      const Lattices<S> other(p, gather(level_.frame.directions.data(), j), normal,
                              cell_sizes(level_.frame.edge_length, j));
      const LatticePair t = match_lattices(lattice_, other, q);
      return {lattice_.point(t.i), other.point(t.j)};
    } else {
      // T(p_ji, n_i, o_i, t_ij) of Eq. 5: of the lattice of i put through the unfolded p_ji, the
      // point nearest to p_i. Projected, as q_ij lies in both planes only as far as its epsilon
      // lets it: parallel planes have no common point.
      Lattices<S> moved = lattice_;
      moved.p = project(q + transport(p - q, normal, lattice_.n));
      return {lattice_.p, moved.point(moved.round(lattice_.p))};
    }
  }

  /// Section 3.7: between the value found and its projection onto the plane spanned by the normal
  /// and the constraint's line (or, without a direction, the constraint's point).
  HWY_INLINE void constrain() {
    if (level_.constraints.strengths.empty()) return;
    const Floats strength = gather(level_.constraints.strengths.data(), around_.nodes);
    const Mask constrained = hn::Ne(strength, all(0));
    if (hn::AllFalse(Lanes(), constrained)) return;
    const Vec3s c = gather(level_.constraints.points.data(), around_.nodes);
    const Vec3s d = gather(level_.constraints.directions.data(), around_.nodes);
    // Of the lattice, the point nearest to the line is the one to pull: any of its row would do.
    const Vec3s own = lattice_.point(lattice_.round(c + dot(d, x_ - c) * d));
    // A line that does not lie in the tangent plane must not pull along itself, only sideways.
    const Vec3s across = cross(lattice_.n, d);
    const Floats square = dot(across, across);
    const Vec3s offset =
        choose(hn::Gt(square, all(1e-6f)), (dot(across, c - own) / square) * across, c - own);
    lattice_.p = choose(constrained, project(own + strength * offset), lattice_.p);
  }

  const Level& level_;
  NeighborLanes& around_;
  Vec3s x_;
  Lattices<S> lattice_;  // of the nodes
};

void relax(const Graph& graph, const LatticeFrame& frame, const LineConstraints& constraints,
           int posy, PositionEnergy energy, std::span<const Index> nodes, const Vec3* field,
           Vec3* values) {
  const Level level{graph, frame, constraints, field};
  with_posy(posy, [&]<int S>() {
    with_energy(energy, [&]<PositionEnergy E>() {
      for_lanes(graph, nodes, values,
                [&](NeighborLanes& around) { return Relaxation<S, E>(level, around).run(); });
    });
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

void relax_positions(const Graph& graph, const LatticeFrame& frame,
                     const LineConstraints& constraints, int posy, PositionEnergy energy,
                     std::span<const Index> nodes, const Vec3* field, Vec3* values) {
  MESHGRAIN_BEST_TARGET(relax)(graph, frame, constraints, posy, energy, nodes, field, values);
}

}  // namespace meshgrain
#endif
