#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Along the normal of a face, as long as the face is large.
inline Vec3 area_vector(std::span<const Index> face, const std::vector<Vec3>& positions) {
  Vec3 sum = Vec3::Zero();
  const Vec3& first = positions[face[0]];
  for (std::size_t k = 2; k < face.size(); ++k) {
    sum += (positions[face[k - 1]] - first).cross(positions[face[k]] - first);
  }
  return 0.5f * sum;
}

/// The least sine of the corners of a face as seen along a unit vector: below 0 where the face is
/// turned over or reflex, -1 if an edge has no length.
inline float least_sine(std::span<const Index> face, const std::vector<Vec3>& positions,
                        const Vec3& normal) {
  const std::size_t n = face.size();
  float least = 1;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& p = positions[face[k]];
    const Vec3 a = positions[face[(k + 1) % n]] - p, b = positions[face[(k + n - 1) % n]] - p;
    const float lengths = a.norm() * b.norm();
    least = std::min(least, lengths > 0 ? normal.dot(a.cross(b)) / lengths : -1.0f);
  }
  return least;
}

}  // namespace meshgrain
