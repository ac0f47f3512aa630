#pragma once

#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Of a closed line through some vertices.
inline double loop_length(std::span<const Index> loop, const std::vector<Vec3>& positions) {
  double length = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& next = positions[loop[k + 1 < loop.size() ? k + 1 : 0]];
    length += (positions[loop[k]] - next).norm();
  }
  return length;
}

}  // namespace meshgrain
