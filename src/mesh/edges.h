#pragma once

#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// An edge of a polygon mesh and how many face sides run along it.
struct Edge {
  Index a, b;  ///< a < b
  Index uses;  ///< 1 on a border, more than 2 where the mesh is not manifold
};

/// Every edge once, ordered by `a`, then `b`. Sides from a vertex to itself are left out. Linear
/// time for bounded valence.
std::vector<Edge> edges_of(const Mesh& mesh);

/// What a quality measure asks of a vertex.
struct VertexDegrees {
  std::vector<Index> neighbours;     ///< Number of edges at each vertex.
  std::vector<std::uint8_t> border;  ///< 1 where an edge does not have exactly two faces.
  Index regular = 4;                 ///< Neighbours of a regular inner vertex.
  Index regular_face = 4;            ///< Corners of a regular face.

  /// Whether `v` is an interior vertex without the regular number of neighbours.
  bool irregular(std::size_t v) const {
    return !border[v] && neighbours[v] != 0 && neighbours[v] != regular;
  }
};

VertexDegrees vertex_degrees(const Mesh& mesh, const std::vector<Edge>& edges);

/// The kind of a mesh, as the corners of its regular face: 3 if more than 90 % of the faces are
/// triangles, 6 if more than half are hexagons, else 4.
Index regular_face_degree(const Faces& faces);

}  // namespace meshgrain
