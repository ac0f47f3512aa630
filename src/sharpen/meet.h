#pragma once

#include <Eigen/Dense>
#include <span>

#include "sharpen/chamfers.h"

namespace meshgrain {

/// The point nearest to p on all of the planes. Where there is none, those with longer normals
/// count more. `hardly`: how much it is held where it is, along what they leave open.
inline Eigen::Vector3d meet(const Eigen::Vector3d& p, std::span<const Plane> planes,
                            double hardly = 1e-6) {
  Eigen::Matrix3d matrix = hardly * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Plane& plane : planes) {
    matrix += plane.normal * plane.normal.transpose();
    right -= plane.normal * plane.height(p);
  }
  return p + matrix.ldlt().solve(right);
}

}  // namespace meshgrain
