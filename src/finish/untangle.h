#pragma once

#include "finish/local_search.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Mends bad faces, turned over or nearly degenerate, over the surface. `search` is over the same
/// mesh.
void untangle(const Mesh& mesh, const VertexFaces& around, LocalSearch& search,
              const Context& context);

}  // namespace meshgrain
