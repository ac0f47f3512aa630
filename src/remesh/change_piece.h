#pragma once

#include <vector>

#include "extract/extraction_map.h"
#include "extract/piece.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Whether no vertex within a piece had to be cut to make a map of it.
bool is_manifold(const Piece& piece, const ExtractionMap& map);

/// For put_back(): of each of the `count` vertices of a changed piece that of the piece if it is on
/// the rim, else no_index. `vertex`: of each vertex of the piece's map, what it is there.
std::vector<Index> rim_sources(const Piece& piece, const ExtractionMap& map,
                               const std::vector<Index>& vertex, std::size_t count);

/// Puts a changed piece in its place, unless more faces pass through each other then. Returns
/// whether it did.
bool keep_if_apart(Extraction& whole, const Piece& piece, const Extraction& changed,
                   const std::vector<Index>& sources, const Context& context);

}  // namespace meshgrain
