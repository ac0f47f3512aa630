#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "meshgrain/graph.h"

/// The paper's formulas, written down as they stand: in double precision, with rotation matrices
/// and brute force over the integers. Slow and obvious; shares nothing with the library but its
/// plain data.
namespace meshgrain::reference {

using V = Eigen::Vector3d;

inline V v(const Vec3& x) {
  return x.cast<double>();
}

/// rot(axis, angle) x
inline V rot(const V& axis, double angle, const V& x) {
  return Eigen::AngleAxisd(angle, axis.normalized()) * x;
}

inline double angle(const V& a, const V& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// R_s(o, n, k)
inline V rotate(int s, const V& o, const V& n, int k) {
  return rot(n, k * 2 * std::numbers::pi / s, o);
}

/// rot(n_j x n_i, angle(n_j, n_i)) x. Between opposite normals any half turn about an axis of the
/// plane will do, and none is defined.
inline V unfold(const V& x, const V& nj, const V& ni) {
  const V axis = nj.cross(ni);
  return axis.norm() < 1e-12 ? x : rot(axis, angle(nj, ni), x);
}

/// What separates two symmetric directions: at most pi / s.
inline double angle_modulo(int s, const V& a, const V& b, const V& n) {
  double least = 10;
  for (int k = 0; k < s; ++k) least = std::min(least, angle(a, rotate(s, b, n, k)));
  return least;
}

struct Match {
  int i = 0, j = 0;
  double angle = 10;
  /// By how much the next larger angle exceeds it. Opposite pairs make the same angle, but for what
  /// single precision leaves of a tangent vector out of its plane.
  double margin = 10;
};

inline Match least(std::vector<Match> all) {
  std::sort(all.begin(), all.end(),
            [](const Match& a, const Match& b) { return a.angle < b.angle; });
  Match best = all.front();
  for (const Match& m : all) {
    if (m.angle > best.angle + 2e-6) {
      best.margin = m.angle - best.angle;
      break;
    }
  }
  return best;
}

/// arg min over k of the angle between o_i and R(o_ji, n_i, k)
inline Match match_intrinsic(int s, const V& oi, const V& ni, const V& oji) {
  std::vector<Match> all;
  for (int k = 0; k < s; ++k) all.push_back({0, k, angle(oi, rotate(s, oji, ni, k))});
  return least(all);
}

/// arg min over k, l of the angle between R(o_i, n_i, k) and R(o_j, n_j, l)
inline Match match_extrinsic(int s, const V& oi, const V& ni, const V& oj, const V& nj) {
  std::vector<Match> all;
  for (int k = 0; k < s; ++k) {
    for (int l = 0; l < s; ++l) {
      all.push_back({k, l, angle(rotate(s, oi, ni, k), rotate(s, oj, nj, l))});
    }
  }
  return least(all);
}

/// A tangential lattice T_s(p, n, o). The paper's third axis for s = 6 adds no points: it is the
/// second less the first.
struct Lattice {
  int s;
  V p, o, n;
  double rho;

  V point(int a, int b) const { return p + rho * (a * o + b * rotate(s, o, n, 1)); }

  /// The integers of the cell that x lies in: the axes span the plane, so by least squares.
  std::array<int, 2> cell(const V& x) const {
    Eigen::Matrix<double, 3, 2> axes;
    axes.col(0) = rho * o;
    axes.col(1) = rho * rotate(s, o, n, 1);
    const Eigen::Vector2d c = (axes.transpose() * axes).inverse() * axes.transpose() * (x - p);
    return {static_cast<int>(std::floor(c[0])), static_cast<int>(std::floor(c[1]))};
  }

  /// The corners of the cell that x lies in and of `range` cells around it, the nearest first.
  std::vector<V> around(const V& x, int range) const {
    const auto [a, b] = cell(x);
    std::vector<V> points;
    for (int i = -range; i <= range + 1; ++i) {
      for (int j = -range; j <= range + 1; ++j) points.push_back(point(a + i, b + j));
    }
    std::stable_sort(points.begin(), points.end(), [&](const V& l, const V& r) {
      return (l - x).squaredNorm() < (r - x).squaredNorm();
    });
    return points;
  }

  V nearest(const V& x) const { return around(x, 4).front(); }
};

/// A pair of lattice points, one of each lattice, the two nearest to each other.
struct Pair {
  V i, j;
  double distance = std::numeric_limits<double>::max();
  double margin = std::numeric_limits<double>::max();
};

inline Pair nearest_pair(const std::vector<V>& qi, const std::vector<V>& qj) {
  Pair best;
  std::vector<double> all;
  for (const V& a : qi) {
    for (const V& b : qj) {
      const double distance = (a - b).norm();
      all.push_back(distance);
      if (distance < best.distance) {
        best.i = a;
        best.j = b;
        best.distance = distance;
      }
    }
  }
  for (const double d : all) {
    if (d > best.distance + 1e-9) best.margin = std::min(best.margin, d - best.distance);
  }
  return best;
}

/// The sets Q_ij and Q_ji: the corners of the lattice's cell about q.
inline std::vector<V> corners(const Lattice& lattice, const V& q) {
  return lattice.around(q, 0);
}

inline Pair match_lattices(const Lattice& i, const Lattice& j, const V& q) {
  return nearest_pair(corners(i, q), corners(j, q));
}

/// q_ij as the solution of the appendix's constrained problem, by its optimality conditions.
/// Normals must not be parallel.
inline V intermediate_exact(const V& vi, const V& ni, const V& vj, const V& nj) {
  Eigen::Matrix<double, 5, 5> a = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> b;
  a.topLeftCorner<3, 3>() = 4 * Eigen::Matrix3d::Identity();
  a.block<3, 1>(0, 3) = ni;
  a.block<3, 1>(0, 4) = nj;
  a.block<1, 3>(3, 0) = ni.transpose();
  a.block<1, 3>(4, 0) = nj.transpose();
  b << 2 * (vi + vj), ni.dot(vi), nj.dot(vj);
  return (a.inverse() * b).head<3>();
}

/// q_ij by the appendix's formula, with its epsilon.
inline V intermediate(const V& vi, const V& ni, const V& vj, const V& nj) {
  const double c = ni.dot(nj), below = 1 - c * c + 1e-4;
  const double li = 2 * (ni + c * nj).dot(vj - vi) / below;
  const double lj = 2 * (nj + c * ni).dot(vi - vj) / below;
  return 0.5 * (vi + vj) - 0.25 * (li * ni + lj * nj);
}

inline V into_plane(const V& x, const V& origin, const V& n) {
  return x - n * n.dot(x - origin);
}

}  // namespace meshgrain::reference
