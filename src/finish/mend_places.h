#pragma once

#include "finish/local_search.h"
#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/finish.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Mends what untangle() leaves, mostly in crevices and thin parts: faces that pass through each
/// other, are turned over or nearly degenerate. They move over the surface, or if that fails a
/// little off it; if that fails too, they let go of the features that hold them. Where nothing
/// helps, or the surface passes through itself, all stays as it was. `search` is over the same
/// mesh.
void mend_places(const Mesh& mesh, const VertexFaces& around, Placement& placement,
                 LocalSearch& search, const SmoothOptions& options, const Context& context);

}  // namespace meshgrain
