#pragma once

#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The normals of vertex_normals() without creases, and the dual areas: of each triangle the part
/// of a Voronoi cell, cut to the triangle where that is obtuse (Meyer et al. 2003, "mixed area").
struct VertexMeasures {
  std::vector<Vec3> normals;
  std::vector<float> areas;
};
VertexMeasures measure_vertices(const Mesh& triangles, const VertexFaces& around,
                                const Context& context);

}  // namespace meshgrain
