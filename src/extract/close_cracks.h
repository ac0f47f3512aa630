#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meshgrain/extract.h"

namespace meshgrain {

/// Where pieces of a surface meet along an edge that is not manifold, each has a chain of edges
/// along the same line, but with vertices that may differ. Makes those one that are close to each
/// other, and gives edges that have none the vertices of the others beside them, so that no crack
/// is left. Triangles stay triangles; other faces get no more corners than `most_corners`.
/// `on_cut`: a flag a vertex, for those that are known to be on such edges. `same_line`: of each
/// line, one that stands for all that were one before the surface was cut.
void close_cracks(Extraction& extraction, const std::vector<std::uint8_t>& on_cut,
                  std::span<const Index> same_line, std::size_t most_corners,
                  const Context& context);

}  // namespace meshgrain
