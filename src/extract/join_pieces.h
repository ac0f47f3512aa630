#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "extract/mesh_clusters.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Makes the pieces that a non-manifold surface was cut into meet again: two vertices that share
/// vertices of the surface become one, those that share most first, unless they share a face. Edges
/// become one only where the surface has edges between more than two faces; cracks are closed
/// there. `vertex`: of the extraction, for each cluster, or no_index. `same_line`: see
/// close_cracks(). `most_corners`: of a face.
void join_pieces(Extraction& extraction, std::vector<CollapsedMesh::Meeting> meetings,
                 std::span<const Index> vertex, std::span<const Index> same_line,
                 std::size_t most_corners, const Context& context);

/// Of each line of a surface that was cut (ExtractOptions::sources), the first of those that ran
/// along the same edges before.
std::vector<Index> lines_before_cut(const FeatureLines& lines, std::span<const Index> sources);
/// A flag for each line of which there are several; empty if that holds for none.
std::vector<std::uint8_t> lines_of_cut(std::span<const Index> same_line);

}  // namespace meshgrain
