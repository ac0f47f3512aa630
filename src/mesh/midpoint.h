#pragma once

#include <Eigen/Geometry>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// A new vertex in the middle between two others, with all that belongs to it.
inline void append_midpoint(Mesh& mesh, Index a, Index b) {
  mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
  if (!mesh.normals.empty()) {
    const Vec3 sum = mesh.normals[a] + mesh.normals[b];
    mesh.normals.push_back(sum.norm() > 1e-6f ? Vec3(sum.normalized()) : mesh.normals[a]);
  }
  if (!mesh.values.empty()) mesh.values.push_back(0.5f * (mesh.values[a] + mesh.values[b]));
}

}  // namespace meshgrain
