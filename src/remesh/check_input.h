#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Throws Error if a mesh refers to vertices that it does not have, holds a number that is not
/// finite, or has normals or values for some of its vertices only. Meshes that were read from files
/// are sound; those that a caller made may not be.
void check_input(const Mesh& input, const Context& context);

}  // namespace meshgrain
