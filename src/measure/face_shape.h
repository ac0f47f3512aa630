#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Of fewer faces most are large beside the bends of what they cover, and nothing takes long: what
/// saves time because a face is about flat is left there.
inline constexpr std::size_t few_faces = 1500;

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
  float least = 1;
  Vec3 back = positions[face.back()] - positions[face[0]];
  float back_squared = back.squaredNorm();
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vec3& next = positions[face[k + 1 < face.size() ? k + 1 : 0]];
    const Vec3 ahead = next - positions[face[k]];
    const float ahead_squared = ahead.squaredNorm(), squares = ahead_squared * back_squared;
    const float height = normal.dot(ahead.cross(back));
    least = std::min(least, squares > 0 ? height / std::sqrt(squares) : -1.0f);
    back = -ahead;
    back_squared = ahead_squared;
  }
  return least;
}

/// Of a quad: the least sine of its corners along its own normal.
inline float scaled_jacobian(std::span<const Index> quad, const std::vector<Vec3>& positions) {
  return least_sine(quad, positions, area_vector(quad, positions).normalized());
}

/// That of the flattest quad of a mesh; 1 without any.
inline float least_jacobian(const Mesh& mesh) {
  float least = 1;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    if (face.size() == 4) least = std::min(least, scaled_jacobian(face, mesh.positions));
  }
  return least;
}

/// The mean length of the edges of some faces; one between two of them counts for both.
inline float mean_edge(const Mesh& mesh, std::span<const Index> faces) {
  float sum = 0, count = 0;
  for (const Index f : faces) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      sum += (mesh.positions[face[k]] - mesh.positions[face[(k + 1) % face.size()]]).norm();
      ++count;
    }
  }
  return sum / count;
}

/// What a face is worth: its least sine along its own normal, below -1 if that looks away from
/// `upward`. `area`: its area vector.
inline float face_quality(std::span<const Index> face, const std::vector<Vec3>& positions,
                          const Vec3& area, const Vec3& upward) {
  const float length = area.norm();
  if (!(length > 0)) return -1;
  const Vec3 normal = area / length;
  const float least = least_sine(face, positions, normal);
  const float towards = normal.dot(upward);
  return towards < 0 ? std::min(least, 0.0f) - 1 + towards : least;
}

}  // namespace meshgrain
