#include "field/relax_positions.h"

#include <array>

#include "field/with_symmetry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/relax_positions.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "field/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// Integers of a lattice as floats: all that is asked of them is to be added and multiplied.
using Coordinates = std::array<Floats, 2>;

/// PoSy of field/posy.h, one a lane.
template <int S>
struct Lattices {
  Vec3s p, u, v, n;
  Floats inverse_square;

  HWY_INLINE Lattices(const Vec3s& position, const Vec3s& orientation, const Vec3s& normal,
                      const Floats& rho)
      : p(position), u(rho * orientation), n(normal), inverse_square(all(1) / (rho * rho)) {
    const Vec3s side = cross(n, u);
    if constexpr (S == 4) {
      v = side;
    } else {
      v = all(0.5f) * u + all(0.866025404f) * side;
    }
  }

  HWY_INLINE Vec3s point(const Coordinates& t) const { return p + t[0] * u + t[1] * v; }

  HWY_INLINE Coordinates components(const Vec3s& d) const {
    const Floats a = dot(d, u) * inverse_square, b = dot(d, v) * inverse_square;
    if constexpr (S == 4) {
      return {a, b};
    } else {
      return {(all(4) * a - all(2) * b) / all(3), (all(4) * b - all(2) * a) / all(3)};
    }
  }

  HWY_INLINE Coordinates floor(const Vec3s& x) const {
    const Coordinates c = components(x - p);
    return {hn::Floor(c[0]), hn::Floor(c[1])};
  }

  HWY_INLINE Coordinates round(const Vec3s& x) const {
    const Coordinates c = components(x - p);
    const Coordinates cell{hn::Floor(c[0]), hn::Floor(c[1])};
    const Corner corner = nearest_corner(c[0] - cell[0], c[1] - cell[1]);
    return {cell[0] + corner.t[0], cell[1] + corner.t[1]};
  }

  struct Corner {
    Coordinates t;
    Floats squared_distance;
  };

  static HWY_INLINE Corner nearest_corner(const Floats& a, const Floats& b) {
    if constexpr (S == 4) {
      const Floats half = all(0.5f), one = all(1);
      const Floats i = hn::IfThenElseZero(hn::Gt(a, half), one);
      const Floats j = hn::IfThenElseZero(hn::Gt(b, half), one);
      const Floats x = a - i, y = b - j;
      return {{i, j}, x * x + y * y};
    } else {
      Corner best{{all(0), all(0)}, a * a + a * b + b * b};
      for (int k = 1; k < 4; ++k) {
        const Floats i = all(static_cast<float>(k / 2)), j = all(static_cast<float>(k % 2));
        const Floats x = a - i, y = b - j;
        const Floats distance = x * x + x * y + y * y;
        const Mask nearer = hn::Lt(distance, best.squared_distance);
        best = {{choose(nearer, i, best.t[0]), choose(nearer, j, best.t[1])},
                choose(nearer, distance, best.squared_distance)};
      }
      return best;
    }
  }
};

/// The two points that match_lattices() of field/posy.h finds.
template <int S>
HWY_INLINE std::array<Vec3s, 2> matched_points(const Lattices<S>& i, const Lattices<S>& j,
                                               const Vec3s& q) {
  const Coordinates cell_i = i.floor(q), cell_j = j.floor(q);
  const Vec3s d = j.point(cell_j) - i.p;
  const Coordinates base = i.components(d), du = i.components(j.u), dv = i.components(j.v);
  const Floats height = dot(i.n, d), height_u = dot(i.n, j.u), height_v = dot(i.n, j.v);
  const Floats x0 = base[0] - cell_i[0], y0 = base[1] - cell_i[1];
  Floats best_distance = all(1e30f);
  Coordinates best_i{all(0), all(0)}, best_j = best_i;
  for (int k = 0; k < 4; ++k) {
    const Floats s = all(static_cast<float>(k / 2)), t = all(static_cast<float>(k % 2));
    const auto corner =
        Lattices<S>::nearest_corner(x0 + s * du[0] + t * dv[0], y0 + s * du[1] + t * dv[1]);
    const Floats h = height + s * height_u + t * height_v;
    const Floats distance = corner.squared_distance + h * h * i.inverse_square;
    const Mask nearer = hn::Lt(distance, best_distance);
    best_distance = choose(nearer, distance, best_distance);
    for (int axis = 0; axis < 2; ++axis) {
      best_i[axis] = choose(nearer, corner.t[axis], best_i[axis]);
      best_j[axis] = choose(nearer, axis == 0 ? s : t, best_j[axis]);
    }
  }
  return {i.point({cell_i[0] + best_i[0], cell_i[1] + best_i[1]}),
          j.point({cell_j[0] + best_j[0], cell_j[1] + best_j[1]})};
}

/// intermediate_position() of field/posy.h.
HWY_INLINE Vec3s intermediate_positions(const Vec3s& vi, const Vec3s& ni, const Vec3s& vj,
                                        const Vec3s& nj) {
  const Floats cosine = dot(ni, nj);
  const Floats denominator = all(1) / (all(1) - cosine * cosine + all(1e-4f));
  const Vec3s d = vj - vi;
  const Floats i = dot(ni, d), j = dot(nj, d);
  const Floats lambda_i = all(2) * (i + cosine * j) * denominator;
  const Floats lambda_j = all(-2) * (j + cosine * i) * denominator;
  return all(0.5f) * (vi + vj) - all(0.25f) * (lambda_i * ni + lambda_j * nj);
}

struct Level {
  const Graph& graph;
  const LatticeFrame& frame;
  const LineConstraints& constraints;
  const Vec3* field;

  HWY_INLINE Floats edge_lengths(const Ints& nodes) const {
    const auto& values = frame.edge_length.values;
    return frame.edge_length.uniform() ? all(values[0]) : gather(values.data(), nodes);
  }
};

template <int S, PositionEnergy E>
class Relaxation {
 public:
  HWY_INLINE Relaxation(const Level& level, NeighborLanes& around)
      : level_(level),
        around_(around),
        x_(gather(level.graph.positions.data(), around.nodes)),
        lattice_(
            gather(level.field, around.nodes), gather(level.frame.directions.data(), around.nodes),
            gather(level.graph.normals.data(), around.nodes), level.edge_lengths(around.nodes)) {}

  HWY_INLINE Vec3s run() {
    Vec3s& mean = lattice_.p;  // so far
    Floats total = all(0);
    while (around_.next()) {
      const auto [own, other] = matched();
      const Floats& w = around_.weights;
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
                              level_.edge_lengths(j));
      return matched_points(lattice_, other, q);
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
    const auto with = [&]<PositionEnergy E>() {
      for_lanes(graph, nodes, values,
                [&](NeighborLanes& around) { return Relaxation<S, E>(level, around).run(); });
    };
    energy == PositionEnergy::intrinsic ? with.template operator()<PositionEnergy::intrinsic>()
                                        : with.template operator()<PositionEnergy::extrinsic>();
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

HWY_EXPORT(relax);

void relax_positions(const Graph& graph, const LatticeFrame& frame,
                     const LineConstraints& constraints, int posy, PositionEnergy energy,
                     std::span<const Index> nodes, const Vec3* field, Vec3* values) {
  HWY_DYNAMIC_DISPATCH(relax)(graph, frame, constraints, posy, energy, nodes, field, values);
}

}  // namespace meshgrain
#endif
