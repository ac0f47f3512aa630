#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/border.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Where sharp edges are looked for, and those that were found.
struct SharpSearch {
  std::span<const Vec3> normals;  ///< Of the faces; zero where one has none.
  double flattest;                ///< Their cosine is less at sharp edges.
  std::vector<SharpEdge>& found;

  double cosine(Index left, Index right) const { return normals[left].dot(normals[right]); }

  /// Adds the edge between two faces, if it is sharp.
  void look_at(const std::array<Index, 2>& ends, Index left, Index right) {
    const double here = cosine(left, right);
    if (here < flattest && !normals[left].isZero(0) && !normals[right].isZero(0)) {
      found.push_back({ends, here});
    }
  }
};

/// Sets whether the vertices from `begin` on, as many as there are flags, of a mesh of triangles
/// are rings: all of their edges lie between two faces of opposite direction, of which there are at
/// most VertexRing::most. Sharp edges from these to larger indices are appended, in order. Quicker
/// than VertexRing, for the many vertices at which there is nothing to see.
void find_rings(const Mesh& triangles, const VertexFaces& around, std::size_t begin,
                std::span<std::uint8_t> is_ring, SharpSearch* sharp = nullptr);

}  // namespace meshgrain
