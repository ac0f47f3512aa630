#pragma once

#include "meshgrain/context.h"
#include "meshgrain/fields.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The side that all faces would have if their areas were as even as their relative sizes (of each
/// vertex) ask for.
float mean_side(const Mesh& mesh, const EdgeLength& relative, const Context& context);

}  // namespace meshgrain
