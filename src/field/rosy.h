#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The smallest rotation that takes the tangent plane with normal `from` to the one with normal
/// `to`, applied to a vector of the former: rot(n_j x n_i, angle(n_j, n_i)) of section 3.2, without
/// trigonometry.
inline Vec3 transport(const Vec3& tangent, const Vec3& from, const Vec3& to) {
  const float cosine = from.dot(to);
  if (cosine < -0.9999f) return tangent;  // opposite normals: every half turn is as small
  return tangent - (from + to) * (to.dot(tangent) / (1 + cosine));
}

inline Vec3 project_to_plane(const Vec3& v, const Vec3& normal) {
  return v - normal * normal.dot(v);
}

/// Some unit vector orthogonal to `normal`, continuous almost everywhere (Duff et al. 2017).
inline Vec3 any_tangent(const Vec3& normal) {
  const float sign = std::copysign(1.0f, normal.z());
  const float a = -1 / (sign + normal.z());
  return {1 + sign * normal.x() * normal.x() * a, sign * normal.x() * normal.y() * a,
          -sign * normal.x()};
}

/// Rotations that match two neighbours' representatives: k_ij and k_ji.
struct Rotations {
  int i = 0, j = 0;
};

/// The symmetry group of an N-RoSy: rotations by multiples of 2 pi / N about the normal
/// (section 3.2).
template <int N>
struct RoSy {
  static_assert(N == 1 || N == 2 || N == 4 || N == 6);

  /// R(o, n, k) for 0 <= k < N.
  static Vec3 rotate(const Vec3& o, const Vec3& n, int k) {
    if constexpr (N == 1) {
      return o;
    } else if constexpr (N == 2) {
      return k == 0 ? o : Vec3(-o);
    } else if constexpr (N == 4) {
      switch (k) {
        case 0:
          return o;
        case 1:
          return n.cross(o);
        case 2:
          return -o;
        default:
          return o.cross(n);
      }
    } else {
      constexpr float half_root3 = 0.866025404f;
      constexpr float cosine[6] = {1, 0.5f, -0.5f, -1, -0.5f, 0.5f};
      constexpr float sine[6] = {0, half_root3, half_root3, 0, -half_root3, -half_root3};
      return k == 0 ? o : Vec3(cosine[k] * o + sine[k] * n.cross(o));
    }
  }

  static int compose(int a, int b) { return (a + b) % N; }
  static int inverse(int k) { return (N - k) % N; }

  /// arg min over k, l of the angle between R(o_i, n_i, k) and R(o_j, n_j, l) in space. `o_i` may
  /// have any length. Both representatives turn only through half a circle, as opposite pairs make
  /// the same angle.
  static Rotations match_extrinsic(const Vec3& oi, const Vec3& ni, const Vec3& oj, const Vec3& nj) {
    if constexpr (N == 1) {
      return {};
    } else {
      constexpr int half = N / 2;
      Vec3 a[half], b[half];
      for (int k = 0; k < half; ++k) {
        a[k] = rotate(oi, ni, k);
        b[k] = rotate(oj, nj, k);
      }
      Rotations best;
      float best_cosine = -1;
      for (int k = 0; k < half; ++k) {
        for (int l = 0; l < half; ++l) {
          const float cosine = a[k].dot(b[l]);
          if (std::fabs(cosine) > best_cosine) {
            best_cosine = std::fabs(cosine);
            best = {k, cosine < 0 ? l + half : l};
          }
        }
      }
      return best;
    }
  }

  /// arg min over k of the angle between o_i and R(o_ji, n_i, k), with o_ji = o_j transported into
  /// the tangent plane of i (which this takes as its second argument).
  static int match_intrinsic(const Vec3& oi, const Vec3& ni, const Vec3& oji) {
    if constexpr (N == 1) {
      return 0;
    } else if constexpr (N == 2) {
      return oi.dot(oji) < 0 ? 1 : 0;
    } else {
      int best = 0;
      float best_cosine = -1;
      for (int k = 0; k < N / 2; ++k) {
        const float cosine = oi.dot(rotate(oji, ni, k));
        if (std::fabs(cosine) > best_cosine) {
          best_cosine = std::fabs(cosine);
          best = cosine < 0 ? k + N / 2 : k;
        }
      }
      return best;
    }
  }
};

}  // namespace meshgrain
