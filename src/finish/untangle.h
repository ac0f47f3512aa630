#pragma once

#include "finish/placement.h"
#include "mesh/vertex_faces.h"

namespace meshgrain {

/// Moves single vertices of bad faces, turned over or nearly degenerate, to where the worst of the
/// faces around them is best. Returns how many faces stay turned over.
std::size_t untangle(Extraction& extraction, const VertexFaces& around, Placement& placement,
                     const Context& context);

}  // namespace meshgrain
