#pragma once

#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// As in meshgrain/normals.h, where the faces around each vertex are known.
std::vector<Vec3> vertex_normals(const Mesh& mesh, const VertexFaces& around, double crease_degrees,
                                 const Context& context);

/// Makes unit vectors of normals that were summed up, of triangles without creases: anew where
/// faces lie back to back, so that hardly anything is left of the sum.
void finish_normals(const Mesh& mesh, const VertexFaces& around, std::vector<Vec3>& sums,
                    const Context& context);

}  // namespace meshgrain
