#pragma once

#include "features/feature_edges.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// How each vertex of a mesh is held (Hold) by the features that its edges follow.
std::vector<std::uint8_t> held_vertices(const Extraction& extraction);

}  // namespace meshgrain
