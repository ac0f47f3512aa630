#pragma once

#include <Eigen/Geometry>
#include <span>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "util/sum.h"

namespace meshgrain {

inline Eigen::AlignedBox3f bounding_box(std::span<const Vec3> points, const Context& context) {
  struct Box : Eigen::AlignedBox3f {
    Box operator+(const Box& other) const { return {merged(other)}; }
  };
  return sum_over_ranges(
      points.size(),
      [&](std::size_t begin, std::size_t end) {
        Box box;
        for (std::size_t i = begin; i < end; ++i) box.extend(points[i]);
        return box;
      },
      context);
}

}  // namespace meshgrain
