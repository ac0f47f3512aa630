#pragma once

#include <cstddef>

#include "cloud/nearest_neighbors.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Puts points between neighbours that lie farther `apart`, where the surface through both is,
/// until there are none: what subdivide() is for a mesh. Gaps wider than a neighbourhood stay, and
/// sides that do not look about the same way. The cloud has normals; `nearest` is then of all
/// points. Returns how many there are more.
std::size_t fill_in(Mesh& cloud, Neighborhoods& nearest, float apart, const Context& context);

}  // namespace meshgrain
