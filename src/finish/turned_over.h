#pragma once

#include <utility>

#include "measure/face_shape.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Whether a face looks away from the surface at each of its vertices. `node_normals`: of the
/// surface, at the nodes that the extraction tells.
inline bool looks_away(const Extraction& extraction, Index f,
                       const std::vector<Vec3>& node_normals) {
  const auto face = extraction.mesh.faces[f];
  const Vec3 area = area_vector(face, extraction.mesh.positions);
  for (const Index v : face) {
    if (!(area.dot(node_normals[extraction.nodes[v]]) < 0)) return false;
  }
  return true;
}

/// The area vectors of the faces around the vertices of a face, but for its own; those beside its
/// edges count twice.
inline Vec3 area_around(const Mesh& mesh, Index f, const VertexFaces& around) {
  const auto face = mesh.faces[f];
  Vec3 sum = -static_cast<float>(face.size()) * area_vector(face, mesh.positions);
  for (const Index v : face) {
    for (const Index g : around[v]) sum += area_vector(mesh.faces[g], mesh.positions);
  }
  return sum;
}

/// Whether a face is turned over as a whole: it looks away from the surface, and from the faces
/// around it. On the wrong side of a thin part all of them look away together.
inline bool is_turned_over(const Extraction& extraction, Index f, const VertexFaces& around,
                           const std::vector<Vec3>& node_normals) {
  const Vec3 area = area_vector(std::as_const(extraction.mesh.faces)[f], extraction.mesh.positions);
  return looks_away(extraction, f, node_normals) &&
         area.dot(area_around(extraction.mesh, f, around)) < 0;
}

}  // namespace meshgrain
