#pragma once

#include <array>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "sharpen/chamfered_part.h"

namespace meshgrain {

/// Puts vertices to where the smooth parts on both sides of each chamfer would meet, and those on
/// all sides of each corner (after Attene et al. 2003). Returns the edges of these creases; none if
/// it was no such part after all, for which less is enough where it is only `perhaps` one. The
/// border stays where it is. Lines shorter than `shortest` are none.
std::vector<std::array<Index, 2>> sharpen_chamfers(Mesh& triangles, double shortest, Chamfered part,
                                                   const Context& context);

}  // namespace meshgrain
