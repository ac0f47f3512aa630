#pragma once

#include <span>

#include "finish/rails.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Slides vertices a little along lines that turn sharply between them, to where the edges cut off
/// less: ragged borders of scans. `edges` are those of the mesh that follow lines.
void fit_to_rails(Mesh& mesh, std::span<const LineEdge> edges, Rails& rails);

}  // namespace meshgrain
