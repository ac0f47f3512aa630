#pragma once

#include "finish/local_search.h"
#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Finds faces that pass through each other, as they do in crevices and thin parts, and moves them
/// apart: over the surface, or if that fails a little off it. Where nothing helps, as where the
/// surface passes through itself, all stays as it was. `search` is over the same mesh.
void part_crossings(const Mesh& mesh, const VertexFaces& around, const Placement& placement,
                    LocalSearch& search, const Context& context);

}  // namespace meshgrain
