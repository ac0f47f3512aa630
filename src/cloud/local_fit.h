#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// What the points around one of a cloud lie on: a plane, or a surface of second degree over it, of
/// least squares. Weights fall to a twentieth at the farthest neighbour, which follows the
/// curvature about as well as half as many neighbours of equal weight would, and noise still
/// averages out.
class LocalFit {
 public:
  /// The point and these neighbours, the nearest first; if there are `normals`, only those that
  /// look to the same side.
  void look(std::span<const Vec3> points, std::span<const Vec3> normals, Index point,
            std::span<const Index> neighbors);

  /// Its normal, of either sign, and two directions in it; how far points are spread along each.
  struct Plane {
    Eigen::Matrix3d axes;
    Eigen::Vector3d variances;
  };
  Plane plane() const;

  /// From the point to where the surface over that plane passes it (Levin 2004).
  Eigen::Vector3d way_to_surface() const;

 private:
  std::vector<Eigen::Vector3d> places_;  // seen from the point
  std::vector<double> weights_;
};

}  // namespace meshgrain
