#pragma once

#include <array>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Whether hardly anything of a surface is not smooth but chamfers about as narrow as its
/// triangles. Marching cubes leave such of all sharp edges, as of each cell of their grid they only
/// look at the corners. `sample` is some of the surface, and tells most others at once.
bool is_chamfered_part(const Mesh& triangles, const Mesh& sample, const Context& context);

/// Puts vertices to where the smooth parts on both sides of each chamfer would meet, and those on
/// all sides of each corner (after Attene et al. 2003). Returns the edges of these creases; none if
/// it was no such part after all. Lines shorter than `shortest` are none.
std::vector<std::array<Index, 2>> sharpen_chamfers(Mesh& triangles, double shortest,
                                                   const Context& context);

}  // namespace meshgrain
