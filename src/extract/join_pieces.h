#pragma once

#include <span>
#include <vector>

#include "extract/mesh_clusters.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Makes the pieces that a non-manifold surface was cut into meet again: two vertices that share
/// vertices of the surface become one, those that share most first, unless they share a face. Edges
/// become one only where the surface has edges between more than two faces; cracks are closed
/// there. `vertex`: of the extraction, for each cluster, or no_index. `most_corners`: of a face.
void join_pieces(Extraction& extraction, std::vector<CollapsedMesh::Meeting> meetings,
                 std::span<const Index> vertex, std::size_t most_corners, const Context& context);

}  // namespace meshgrain
