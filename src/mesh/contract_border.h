#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Merges the ends of edges of the border that lie at exactly the same place: so programs write the
/// poles of spheres, with a vertex for each meridian. Where the whole of a border does, there is no
/// hole any more. `border` must be the mesh's border_edges(), and is so afterwards. Returns the
/// number of vertices that were merged into others.
std::size_t contract_border(Mesh& mesh, std::vector<std::array<Index, 2>>& border,
                            const Context& context);

}  // namespace meshgrain
