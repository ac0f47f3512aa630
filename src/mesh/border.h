#pragma once

#include <array>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The edges that only one face uses, as the vertices at their ends in the order of that face.
std::vector<std::array<Index, 2>> border_edges(const Mesh& mesh);

}  // namespace meshgrain
