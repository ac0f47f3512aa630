#pragma once

#include <array>
#include <cmath>

#include "field/rosy.h"

namespace meshgrain {

/// std::floor without its call, which the common instruction set has no instruction for.
inline int floor_to_int(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (static_cast<float>(truncated) > x);
}

/// The translations of an S-PoSy: the square (S = 4) or triangular (S = 6) lattice in the tangent
/// plane of a node, through its position p, along its orientation o, with edge length rho
/// (section 3.3). Integers are relative to p. For S = 6 two axes at 60 degrees reach every point
/// that the paper's three reach.
template <int S>
struct PoSy {
  static_assert(S == 4 || S == 6);

  Vec3 p, u, v, n;  // u, v: the axes, of length rho
  float inverse_square;

  PoSy(const Vec3& position, const Vec3& orientation, const Vec3& normal, float rho)
      : p(position), u(orientation * rho), n(normal), inverse_square(1 / (rho * rho)) {
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
  std::array<float, 2> coordinates(const Vec3& x) const { return components(x - p); }

  /// The same of a vector.
  std::array<float, 2> components(const Vec3& d) const {
    const float a = d.dot(u) * inverse_square, b = d.dot(v) * inverse_square;
    if constexpr (S == 4) {
      return {a, b};
    } else {
      return {(4 * a - 2 * b) / 3, (4 * b - 2 * a) / 3};
    }
  }

  /// The lattice point nearest to x: round_4 of the appendix. For S = 6 the appendix rounds the
  /// coordinates, which is not always the nearest point; here the cell's corners are compared.
  std::array<int, 2> round(const Vec3& x) const {
    const auto c = coordinates(x);
    const std::array<int, 2> cell{floor_to_int(c[0]), floor_to_int(c[1])};
    const auto corner =
        nearest_corner(c[0] - static_cast<float>(cell[0]), c[1] - static_cast<float>(cell[1]));
    return {cell[0] + corner.t[0], cell[1] + corner.t[1]};
  }

  std::array<int, 2> floor(const Vec3& x) const {
    const auto c = coordinates(x);
    return {floor_to_int(c[0]), floor_to_int(c[1])};
  }

  struct Corner {
    std::array<int, 2> t;    // 0 or 1 each
    float squared_distance;  // in squared edge lengths
  };

  /// Of the four corners (0 or 1, 0 or 1) of a cell, that nearest to the point at (a, b).
  static Corner nearest_corner(float a, float b) {
    if constexpr (S == 4) {
      const int i = a > 0.5f, j = b > 0.5f;
      const float x = a - static_cast<float>(i), y = b - static_cast<float>(j);
      return {{i, j}, x * x + y * y};
    } else {
      Corner best{{0, 0}, 1e30f};
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          const float x = a - static_cast<float>(i), y = b - static_cast<float>(j);
          const float distance = x * x + x * y + y * y;  // axes at 60 degrees
          if (distance < best.squared_distance) best = {{i, j}, distance};
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
/// win, so four roundings replace sixteen distances; and as the four differ by j's axes, so do
/// their coordinates in i's lattice and their heights over its plane.
template <int S>
Translations match_lattices(const PoSy<S>& i, const PoSy<S>& j, const Vec3& q) {
  const auto cell_i = i.floor(q), cell_j = j.floor(q);
  const Vec3 d = j.point(cell_j) - i.p;
  const auto base = i.components(d), du = i.components(j.u), dv = i.components(j.v);
  const float height = i.n.dot(d), height_u = i.n.dot(j.u), height_v = i.n.dot(j.v);
  const float x0 = base[0] - static_cast<float>(cell_i[0]);
  const float y0 = base[1] - static_cast<float>(cell_i[1]);
  Translations best;
  float best_distance = 1e30f;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      const auto s = static_cast<float>(a), t = static_cast<float>(b);
      const auto corner =
          PoSy<S>::nearest_corner(x0 + s * du[0] + t * dv[0], y0 + s * du[1] + t * dv[1]);
      const float h = height + s * height_u + t * height_v;
      const float distance = corner.squared_distance + h * h * i.inverse_square;
      if (distance < best_distance) {
        best_distance = distance;
        best = {{cell_i[0] + corner.t[0], cell_i[1] + corner.t[1]}, {cell_j[0] + a, cell_j[1] + b}};
      }
    }
  }
  return best;
}

}  // namespace meshgrain
