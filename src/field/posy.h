#pragma once

#include <array>
#include <cmath>

#include "field/rosy.h"

namespace meshgrain {


/// The translations of an S-PoSy: the square (S = 4) or triangular (S = 6) lattice in the tangent
/// plane of a node, through its position p, along its orientation o, with edge length rho
/// (section 3.3). Integers are relative to p. For S = 6 two axes at 60 degrees reach every point that
/// the paper's three reach.
template <int S>
struct PoSy {
  static_assert(S == 4 || S == 6);

  Vec3 p, u, v;  // u, v: the axes, of length rho
  float inverse_square;

  PoSy(const Vec3& position, const Vec3& orientation, const Vec3& normal, float rho)
      : p(position), u(orientation * rho), inverse_square(1 / (rho * rho)) {
    const Vec3 side = normal.cross(u);
    if constexpr (S == 4) {
      v = side;
    } else {
      v = 0.5f * u + 0.866025404f * side;
    }
  }

  Vec3 point(const std::array<int, 2>& t) const {
    return p + static_cast<float>(t[0]) * u + static_cast<float>(t[1]) * v;
  }

  /// Real-valued coordinates of (the projection of) a point.
  std::array<float, 2> coordinates(const Vec3& x) const {
    const Vec3 d = x - p;
    const float a = d.dot(u) * inverse_square, b = d.dot(v) * inverse_square;
    if constexpr (S == 4) {
      return {a, b};
    } else {
      return {(4 * a - 2 * b) / 3, (4 * b - 2 * a) / 3};
    }
  }

  /// The lattice point nearest to x: round_4 of the appendix. For S = 6 the appendix rounds the
  /// coordinates, which is not always the nearest point; here the cell's corners are compared.
  std::array<int, 2> round(const Vec3& x) const { return nearest_corner(x, floor(x)); }

  std::array<int, 2> floor(const Vec3& x) const {
    const auto c = coordinates(x);
    return {static_cast<int>(std::floor(c[0])), static_cast<int>(std::floor(c[1]))};
  }

  /// Of the four corners of the cell at `cell`, that nearest to x.
  std::array<int, 2> nearest_corner(const Vec3& x, const std::array<int, 2>& cell) const {
    const auto c = coordinates(x);
    const float a = c[0] - static_cast<float>(cell[0]), b = c[1] - static_cast<float>(cell[1]);
    if constexpr (S == 4) {
      return {cell[0] + (a > 0.5f), cell[1] + (b > 0.5f)};
    } else {
      std::array<int, 2> best{};
      float best_distance = 1e30f;
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          const float x_ = a - static_cast<float>(i), y_ = b - static_cast<float>(j);
          const float distance = x_ * x_ + x_ * y_ + y_ * y_;  // axes at 60 degrees
          if (distance < best_distance) {
            best_distance = distance;
            best = {cell[0] + i, cell[1] + j};
          }
        }
      }
      return best;
    }
  }
};

/// Translations that match two neighbours' lattices: t_ij and t_ji.
struct Translations {
  std::array<int, 2> i{0, 0}, j{0, 0};
};

/// The point nearest to both v_i and v_j in both tangent planes: q_ij of the appendix.
inline Vec3 intermediate_position(const Vec3& vi, const Vec3& ni, const Vec3& vj, const Vec3& nj) {
  const float cosine = ni.dot(nj);
  const float denominator = 1 / (1 - cosine * cosine + 1e-4f);
  const Vec3 d = vj - vi;
  const float i = ni.dot(d), j = nj.dot(d);
  const float lambda_i = 2 * (i + cosine * j) * denominator;
  const float lambda_j = -2 * (j + cosine * i) * denominator;
  return 0.5f * (vi + vj) - 0.25f * (ni * lambda_i + nj * lambda_j);
}

/// arg min over the corners of both lattices' cells around q_ij of the distance between the two
/// points (section 3.3). For each of the four corners of j's cell only i's corner nearest to it can
/// win, so four roundings replace sixteen distances.
template <int S>
Translations match_lattices(const PoSy<S>& i, const PoSy<S>& j, const Vec3& q) {
  const auto cell_i = i.floor(q), cell_j = j.floor(q);
  Translations best;
  float best_distance = 1e30f;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      const std::array<int, 2> tj{cell_j[0] + a, cell_j[1] + b};
      const Vec3 point_j = j.point(tj);
      const auto ti = i.nearest_corner(point_j, cell_i);
      const float distance = (i.point(ti) - point_j).squaredNorm();
      if (distance < best_distance) {
        best_distance = distance;
        best = {ti, tj};
      }
    }
  }
  return best;
}

}  // namespace meshgrain
