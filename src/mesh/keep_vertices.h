#pragma once

#include <cstddef>
#include <span>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Leaves a mesh these vertices alone, in increasing order. Faces and marks stay as they are.
void keep_vertices(Mesh& mesh, std::span<const Index> kept);

/// Those that no face has go. Returns their number.
std::size_t drop_unused_vertices(Mesh& mesh, const Context& context);

}  // namespace meshgrain
