#pragma once

#include <Eigen/Dense>
#include <span>

#include "sharpen/chamfers.h"

namespace meshgrain {

/// The point nearest to p on all of the planes.
inline Eigen::Vector3d meet(const Eigen::Vector3d& p, std::span<const Plane> planes) {
  constexpr double hardly = 1e-6;  // held where it is along what they leave open
  Eigen::Matrix3d matrix = hardly * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Plane& plane : planes) {
    matrix += plane.normal * plane.normal.transpose();
    right -= plane.normal * plane.height(p);
  }
  return p + matrix.ldlt().solve(right);
}

}  // namespace meshgrain
