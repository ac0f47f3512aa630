#pragma once

#include <span>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Whether creases of a part have become chamfers. It is to be seen from how they can be made sharp
/// again where rods, handles and bores of a few triangles' width are no smoother.
enum class Chamfered { no, perhaps, yes };

/// Whether hardly anything of a surface is not smooth but chamfers about as narrow as its
/// triangles. Marching cubes leave such of all sharp edges, as of each cell of their grid they only
/// look at the corners. `samples` are some of the surface and more of it, and tell most others at
/// once.
Chamfered chamfered_part(const Mesh& triangles, std::span<const Mesh> samples,
                         const Context& context);

}  // namespace meshgrain
