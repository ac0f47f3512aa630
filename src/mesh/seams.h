#pragma once

#include <cstddef>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

struct SeamReport {
  std::size_t border_edges = 0;
  /// Those that lie on others, between vertices at exactly the same places: so programs write
  /// meshes that have several normals or texture coordinates at a vertex.
  std::size_t seam_edges = 0;
};

/// The edges of the border, and which of them would go if vertices at one place were merged.
SeamReport find_seams(const Mesh& mesh, const Context& context);

}  // namespace meshgrain
