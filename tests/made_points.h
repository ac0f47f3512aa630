#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "meshgrain/mesh.h"
#include "util/hash.h"

namespace meshgrain::made {

/// A number in [-1, 1) that depends on the seed only.
inline float noise(std::uint64_t seed) {
  return static_cast<float>(hash64(seed + 0x9e3779b97f4a7c15u) >> 40) / 8388608.0f - 1.0f;
}

/// Points with the outward normals of the surface they were taken from.
struct Sample {
  std::vector<Vec3> points, normals;

  void add(const Vec3& point, const Vec3& normal) {
    points.push_back(point);
    normals.push_back(normal);
  }
  void shake(float amount) {
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        points[i][static_cast<Eigen::Index>(axis)] += amount * noise(3 * i + axis);
  }
};

/// Evenly spread on a Fibonacci spiral.
inline Sample sphere(std::size_t count, float radius, const Vec3& centre = Vec3::Zero()) {
  Sample sample;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double r = std::sqrt(1 - z * z), angle = golden * static_cast<double>(i);
    const Vec3 n = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
    sample.add(centre + radius * n, n);
  }
  return sample;
}

/// Around the z axis; `around` x `across` points.
inline Sample torus(std::size_t around, std::size_t across, double major, double minor) {
  Sample sample;
  for (std::size_t i = 0; i < around; ++i)
    for (std::size_t j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(around);
      const double b = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(across);
      const Eigen::Vector3d n(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
      const Eigen::Vector3d c(major * std::cos(a), major * std::sin(a), 0);
      sample.add((c + minor * n).cast<float>(), n.cast<float>());
    }
  return sample;
}

/// A square plate of side 2 with a rounded rim: `side` x `side` points, unevenly placed, above and
/// below, `thickness` apart.
inline Sample plate(std::size_t side, float thickness) {
  Sample sample;
  const float step = 2.0f / static_cast<float>(side - 1), radius = thickness / 2;
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j)
      for (const float z : {1.0f, -1.0f}) {
        const std::uint64_t seed = 8 * (i * side + j) + (z > 0 ? 4 : 0);
        const float x = static_cast<float>(i) * step - 1 + 0.2f * step * noise(seed);
        const float y = static_cast<float>(j) * step - 1 + 0.2f * step * noise(seed + 1);
        sample.add({x, y, z * radius}, {0, 0, z});
      }
  // The rim: half circles swept along the four sides.
  const int slices = std::max(3, static_cast<int>(std::ceil(3.14f * radius / step)));
  for (std::size_t i = 0; i < side; ++i)
    for (int s = 1; s < slices; ++s) {
      const float angle = 3.14159265f * (static_cast<float>(s) / static_cast<float>(slices) - 0.5f);
      const float out = std::cos(angle), up = std::sin(angle);
      const float t = static_cast<float>(i) * step - 1, e = 1 + 0.3f * step;
      for (const float sign : {1.0f, -1.0f}) {
        sample.add({sign * (e + radius * out), t, radius * up}, {sign * out, 0, up});
        sample.add({t, sign * (e + radius * out), radius * up}, {0, sign * out, up});
      }
    }
  return sample;
}

}  // namespace meshgrain::made
