#pragma once

#include <cstddef>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Mends triangles without area whose longest edge passes through the corner opposite to it, as
/// programs leave them where an edge meets the middle of another. That edge is turned to the
/// triangle beyond it, so that both have some area; marks go on along the other two edges. Where
/// the triangle hangs on others by that edge alone it is dropped. Nothing moves by more than the
/// triangle is high, and the topology of a manifold stays. Returns how many were mended.
std::size_t turn_caps(Mesh& triangles, const Context& context);

}  // namespace meshgrain
