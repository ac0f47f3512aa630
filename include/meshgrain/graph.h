#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The neighbour graph on which fields live (section 3.1): nodes with a position, a unit normal and
/// a dual area, and weighted edges. Every edge is stored in both directions.
struct Graph {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<float> areas;
  std::vector<Index> offsets;    ///< nodes + 1: where each node's neighbours start.
  std::vector<Index> neighbors;  ///< In increasing order for each node.
  std::vector<float> weights;    ///< One a neighbour, or empty: all weights are 1.

  std::size_t size() const { return positions.size(); }
  std::span<const Index> neighbors_of(std::size_t i) const {
    return {neighbors.data() + offsets[i], offsets[i + 1] - offsets[i]};
  }
  float weight(std::size_t entry) const { return weights.empty() ? 1.0f : weights[entry]; }
  /// The place of `j`, a neighbour of i, in `neighbors`.
  std::size_t entry(Index i, Index j) const {
    const auto own = neighbors_of(i);
    const auto it = std::lower_bound(own.begin(), own.end(), j);
    return offsets[i] + static_cast<std::size_t>(it - own.begin());
  }
};

enum class GraphNodes {
  vertices,  ///< One node a vertex, neighbours along edges.
  faces,     ///< One node a face, neighbours across edges.
};

enum class GraphWeights {
  uniform,
  geometric,  ///< Cotangents (Pinkall and Polthier 1993), or a heat kernel for point clouds.
};

struct GraphOptions {
  GraphNodes nodes = GraphNodes::vertices;
  GraphWeights weights = GraphWeights::uniform;
  std::size_t neighbors = 10;  ///< K of the nearest neighbours, for point clouds (section 3.1).
  double crease_degrees =
      -1;  ///< Dihedral angle that makes crease normals (section 3.5); < 0: none.
};

/// The graph of a triangle mesh or of a point cloud (whose normals are estimated if it has none).
/// Throws Error if a mesh has other faces than triangles or the cloud has fewer than four points.
Graph build_graph(const Mesh& mesh, const GraphOptions& options = {},
                  const Context& context = Context());

}  // namespace meshgrain
