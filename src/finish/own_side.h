#pragma once

#include <vector>

#include "finish/placement.h"
#include "finish/regular_polygon.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Where the surface is thinner than a face is wide, or bends sharply within one, parts of a face
/// can lie nearer to another side of it, that looks the other way. The free vertices around such
/// faces go where less of that is left, a little off the surface if need be, and the faces stay
/// near to it, even and regular. No two faces pass through each other that did not before.
///
/// `normals` are those of the surface at the vertices, or about so; `fit` says how large faces
/// should be.
void keep_to_own_side(Mesh& mesh, const VertexFaces& around, const Placement& placement,
                      const std::vector<Vec3>& normals, const PolygonFit& fit,
                      const Context& context);

}  // namespace meshgrain
