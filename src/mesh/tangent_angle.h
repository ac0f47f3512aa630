#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The angle at p from one neighbour counterclockwise to another, in the plane of a unit normal: 0
/// to 2 pi.
inline double tangent_angle(const Vec3& p, const Vec3& from, const Vec3& to, const Vec3& normal) {
  const Vec3 a = from - p, b = to - p;
  const double angle = std::atan2(normal.dot(a.cross(b)), a.dot(b) - normal.dot(a) * normal.dot(b));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

}  // namespace meshgrain
