#pragma once

#include <array>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The marked edges of a mesh, sorted, each once and the smaller index first; none from a vertex to
/// itself.
std::vector<std::array<Index, 2>> sorted_marks(const Mesh& mesh);

}  // namespace meshgrain
