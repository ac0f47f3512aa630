#pragma once

#include "finish/local_search.h"
#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Mends bad faces, turned over or nearly degenerate. Those that stay bad let go of the features
/// that hold them. `search` is over the same mesh.
void untangle(const Mesh& mesh, const VertexFaces& around, Placement& placement,
              LocalSearch& search, const Context& context);

}  // namespace meshgrain
