#pragma once

#include "finish/placement.h"
#include "mesh/vertex_faces.h"

namespace meshgrain {

/// Moves single vertices of bad faces, turned over or nearly degenerate, to where the worst of the
/// faces around them is best. Faces that stay bad let go of the features that hold them.
void untangle(Extraction& extraction, const VertexFaces& around, Placement& placement,
              const Context& context);

}  // namespace meshgrain
