#pragma once

#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// The last resort for quads with a corner that is turned in, or straight, as on necks that are
/// thinner than a face, and for faces that are turned over as a whole: the vertices around one
/// leave the surface, by up to the length of an edge, for where no such corner is left. Only if
/// that does not help, faces may pass through each other for it, and vertices leave their feature
/// lines, at last corners, and the border if it need not stay. `node_normals`: of the surface, at
/// the nodes that the extraction tells.
void untwist(Extraction& extraction, const std::vector<Vec3>& node_normals, bool border_stays,
             const Context& context);

}  // namespace meshgrain
