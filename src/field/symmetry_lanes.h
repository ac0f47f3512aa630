// The symmetries of field/rosy.h and field/posy.h, a node or edge a SIMD lane: include it like
// graph/lanes.h.

#if defined(MESHGRAIN_FIELD_SYMMETRY_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHGRAIN_FIELD_SYMMETRY_LANES_H
#undef MESHGRAIN_FIELD_SYMMETRY_LANES_H
#else
#define MESHGRAIN_FIELD_SYMMETRY_LANES_H
#endif

#include <hwy/highway.h>

#include <array>

#include "graph/lanes.h"
#include "meshgrain/fields.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {

/// RoSy<N>::rotate() of field/rosy.h through less than half a circle.
template <int N>
HWY_INLINE Vec3s rotate(const Vec3s& o, const Vec3s& n, int k) {
  if (k == 0) return o;
  if constexpr (N == 4) {
    return cross(n, o);
  } else {
    const float cosine = k == 1 ? 0.5f : -0.5f;
    return all(cosine) * o + all(0.866025404f) * cross(n, o);
  }
}

/// Of the rotations of vectors in planes of normals n, that at the least angle to another one.
template <int N>
HWY_INLINE Vec3s most_similar(const Vec3s& o, const Vec3s& n, const Vec3s& to) {
  if constexpr (N == 1) return o;
  Vec3s best = o;
  Floats best_cosine = all(-1);
  for (int k = 0; k < N / 2; ++k) {
    const Vec3s turned = rotate<N>(o, n, k);
    const Floats cosine = dot(to, turned);
    const Mask better = hn::Gt(hn::Abs(cosine), best_cosine);
    best_cosine = choose(better, hn::Abs(cosine), best_cosine);
    best = choose(better, choose(hn::Lt(cosine, all(0)), -turned, turned), best);
  }
  return best;
}

/// Edge lengths of lattices.
struct CellSizes {
  Floats rho, inverse_square;
};

HWY_INLINE CellSizes cell_sizes(const EdgeLength& lengths, const Ints& nodes) {
  if (lengths.uniform()) {
    const float rho = lengths[0];
    return {all(rho), all(1 / (rho * rho))};
  }
  const Floats rho = gather(lengths.values.data(), nodes);
  return {rho, all(1) / (rho * rho)};
}

/// Integers of a lattice as floats: all that is asked of them is to be added and multiplied.
using Coordinates = std::array<Floats, 2>;

/// PoSy of field/posy.h, one a lane.
template <int S>
struct Lattices {
  Vec3s p, u, v, n;
  Floats inverse_square;

  HWY_INLINE Lattices(const Vec3s& position, const Vec3s& orientation, const Vec3s& normal,
                      const CellSizes& size)
      : p(position), u(size.rho * orientation), n(normal), inverse_square(size.inverse_square) {
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

struct LatticePair {
  Coordinates i, j;
};

/// match_lattices() of field/posy.h.
template <int S>
HWY_INLINE LatticePair match_lattices(const Lattices<S>& i, const Lattices<S>& j, const Vec3s& q) {
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
  return {{cell_i[0] + best_i[0], cell_i[1] + best_i[1]},
          {cell_j[0] + best_j[0], cell_j[1] + best_j[1]}};
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

}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#endif
