#pragma once

#include <vector>

#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Looks at the vertices of folded faces, which are turned over or reflex: where a part of the
/// surface is hardly wider than a face, one may have come to its other side, and would never come
/// back over the surface. It is put between its neighbours, on their side, where that leaves less
/// of the fold. `normals` are those of the surface at the vertices. Returns the vertices that were
/// moved, in increasing order.
std::vector<Index> unfold(Extraction& extraction, const VertexFaces& around, Placement& placement,
                          std::vector<Vec3>& normals, const std::vector<Index>& folded);

}  // namespace meshgrain
