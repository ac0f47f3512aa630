#pragma once

#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Some faces of a mesh, with their vertices' positions, as a mesh of their own.
struct Part {
  Mesh mesh;
  std::vector<Index> vertices;  // of the whole mesh, increasing

  /// The number here of a vertex of the whole mesh, or no_index.
  Index number(Index vertex) const;
};

Part part_of(const Mesh& whole, std::span<const Index> faces);

}  // namespace meshgrain
