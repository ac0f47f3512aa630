#pragma once

#include "extract/face_repair.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Makes every face of a map that is not open a quad, without splitting them all. Faces with an
/// even number of corners are cut. Triangles, pentagons and so on go in pairs: along a way from one
/// to the other over as few faces and with as few turns as can be, every edge that it crosses gets
/// a vertex, so that both have an even number of corners, and what lies between them is cut into
/// rows. Where one is left over, the way goes to the border.
void pair_odd_faces(PolygonMap& map, FaceRepair& repair, const Context& context);

}  // namespace meshgrain
