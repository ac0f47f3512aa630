#pragma once

#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Mends bad faces, turned over or nearly degenerate. Those that stay bad let go of the features
/// that hold them. Then finds faces that pass through each other, as they do where the surface is
/// thin or folded, and moves them apart; where that fails nothing changes.
void untangle(Extraction& extraction, const VertexFaces& around, Placement& placement,
              const Context& context);

}  // namespace meshgrain
