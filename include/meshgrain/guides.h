#pragma once

#include <Eigen/Core>
#include <vector>

#include "meshgrain/polylines.h"

namespace meshgrain {

/// A curve near a surface that edges of the output are to follow: the orientation and edge brushes
/// of section 3.7 in one.
struct Guide {
  std::vector<Eigen::Vector3d> points;  ///< In units of the input; straight from one to the next.
  bool closed = false;                  ///< Whether the last point is joined to the first.
  /// At 1 a chain of edges lies on the guide, from end to end. Below, both fields are drawn towards
  /// it, by so much; also of point clouds, where no guide can do more.
  float strength = 1;
};

/// A guide of each line.
std::vector<Guide> guides_of(const Polylines& lines, float strength = 1);

}  // namespace meshgrain
