#pragma once

#include "finish/placement.h"
#include "finish/regular_polygon.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Where the surface is thinner than a face is wide, or bends sharply within one, parts of a face
/// can lie nearer to another side of it, that looks the other way. The free vertices around such
/// faces go where less of that is left, a little off the surface if need be, and the faces stay
/// near to it, even and regular. No two faces pass through each other that did not before.
///
/// `surface` is the triangle mesh that `placement` is on; `fit` says how large faces should be.
void keep_to_own_side(Extraction& extraction, const VertexFaces& around, Placement& placement,
                      const Mesh& surface, const PolygonFit& fit, const Context& context);

}  // namespace meshgrain
