#pragma once

#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/extract.h"
#include "meshgrain/features.h"

namespace meshgrain {

/// Lets the rims of holes that are far smaller than a face become a little larger: what is around
/// them could have no shape else. `lines` are those of the extraction's edges; `side`: of a face.
void open_small_holes(const Extraction& extraction, const VertexFaces& around,
                      const FeatureLines& lines, float side, Placement& placement);

}  // namespace meshgrain
