#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The point of the segment from a to b closest to p.
template <class Vector>
Vector closest_point_on_segment(const Vector& p, const Vector& a, const Vector& b) {
  using Scalar = typename Vector::Scalar;
  const Vector d = b - a;
  const Scalar length2 = d.squaredNorm();
  if (!(length2 > 0)) return a;
  return a + std::clamp(d.dot(p - a) / length2, Scalar(0), Scalar(1)) * d;
}

/// The point of the triangle a, b, c closest to p. A triangle that has collapsed to a segment or a
/// point counts as that.
template <class Vector>
Vector closest_point_on_triangle(const Vector& p, const Vector& a, const Vector& b,
                                 const Vector& c) {
  using Scalar = typename Vector::Scalar;
  const Vector ab = b - a, ac = c - a, ap = p - a;
  const Vector n = ab.cross(ac);
  const Scalar n2 = n.squaredNorm();
  const Scalar longest2 = std::max(ab.squaredNorm(), ac.squaredNorm());
  constexpr Scalar tiny = 16 * Eigen::NumTraits<Scalar>::epsilon();
  bool beyond_ab = true, beyond_bc = true, beyond_ca = true;
  if (n2 > tiny * tiny * longest2 * longest2) {
    // The barycentric coordinates of p's foot on the plane: inside if none is negative.
    const Scalar v = ap.cross(ac).dot(n), w = ab.cross(ap).dot(n);
    beyond_ab = w < 0;
    beyond_bc = v + w > n2;
    beyond_ca = v < 0;
    if (!beyond_ab && !beyond_bc && !beyond_ca) return a + (v / n2) * ab + (w / n2) * ac;
  }
  // Else the closest point lies on an edge that the foot is beyond.
  Vector best = a;
  Scalar least = std::numeric_limits<Scalar>::infinity();
  const auto look = [&](const Vector& from, const Vector& to) {
    const Vector q = closest_point_on_segment(p, from, to);
    const Scalar distance = (q - p).squaredNorm();
    if (!(distance < least)) return;
    least = distance;
    best = q;
  };
  if (beyond_ab) look(a, b);
  if (beyond_bc) look(b, c);
  if (beyond_ca) look(c, a);
  return best;
}

/// The same for the expressions that Eigen's operators give.
inline Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return closest_point_on_triangle<Vec3>(p, a, b, c);
}

}  // namespace meshgrain
