#pragma once

#include <Eigen/Geometry>

#include "made_points.h"
#include "meshgrain/graph.h"
#include "meshgrain/shapes.h"

namespace meshgrain::made {

/// Moves every vertex by up to `amount` along each axis.
inline Mesh shaken(Mesh mesh, float amount) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      mesh.positions[i][static_cast<Eigen::Index>(axis)] += amount * noise(3 * i + axis);
    }
  }
  return mesh;
}

/// A few hundred nodes with everything in it that a local step could stumble over: noise, bent and
/// equal normals, and weights from 0.1 to 10.
inline Graph noisy_graph() {
  Graph graph = build_graph(shaken(sample_shape("torus", 0.35), 0.03f));
  for (std::size_t i = 0; i < graph.size(); ++i) {
    if (i % 17 == 0)
      graph.normals[i] = (graph.normals[i] + 0.7f * Vec3(noise(i), noise(2 * i), 0)).normalized();
    if (i % 19 == 0) graph.normals[i] = graph.normals[graph.neighbors_of(i)[0]];
  }
  graph.weights.resize(graph.neighbors.size());
  for (std::size_t i = 0; i < graph.size(); ++i) {
    for (std::size_t e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
      const std::size_t j = graph.neighbors[e];
      graph.weights[e] = std::exp(2.3f * noise(1000 * std::min(i, j) + std::max(i, j)));
    }
  }
  return graph;
}

}  // namespace meshgrain::made
