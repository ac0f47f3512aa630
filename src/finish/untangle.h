#pragma once

#include "finish/local_search.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Mends bad faces, turned over or nearly degenerate, over the surface, in up to so many sweeps
/// over what is around them. `search` is over the same mesh.
void untangle(const Mesh& mesh, const VertexFaces& around, LocalSearch& search, int sweeps,
              const Context& context);

}  // namespace meshgrain
