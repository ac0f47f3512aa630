#pragma once

#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// As in meshgrain/normals.h, where the faces around each vertex are known.
std::vector<Vec3> vertex_normals(const Mesh& mesh, const VertexFaces& around, double crease_degrees,
                                 const Context& context);

/// Finds those of triangles without creases that are zero so far, as where faces lie back to back.
void complete_normals(const Mesh& mesh, const VertexFaces& around, std::vector<Vec3>& normals,
                      const Context& context);

}  // namespace meshgrain
