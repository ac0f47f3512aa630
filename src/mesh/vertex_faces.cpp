#include "mesh/vertex_faces.h"

#include <algorithm>

#include "mesh/sort_by_vertex.h"
#include "meshgrain/error.h"
#include "util/sort_unique.h"

namespace meshgrain {
VertexFaces vertex_faces(const Mesh& mesh, const Context& context) {
  const Faces& faces = mesh.faces;
  if (faces.corners().size() >= no_index) {
    throw Error("a mesh can have at most 4294967294 face corners");
  }
  VertexFaces result;
  result.faces.resize(faces.corners().size());
  const auto put = [&](std::size_t f, Index place) { result.faces[place] = static_cast<Index>(f); };
  result.offsets = with_corners(faces, [&](const auto& corners) {
    return sort_by_vertex(faces.size(), mesh.positions.size(), corners, put, context);
  });
  return result;
}

bool share_any(std::span<const Index> a, std::span<const Index> b) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) return true;
    ++(*i < *j ? i : j);
  }
  return false;
}

std::vector<Index> vertices_of(const Mesh& mesh, std::span<const Index> faces) {
  std::vector<Index> result;
  for (const Index f : faces) {
    result.insert(result.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  }
  sort_unique(result);
  return result;
}

std::vector<Index> faces_of(const VertexFaces& around, std::span<const Index> vertices) {
  std::vector<Index> result;
  for (const Index v : vertices) result.insert(result.end(), around[v].begin(), around[v].end());
  sort_unique(result);
  return result;
}

std::vector<Index> with_rings(const Mesh& mesh, const VertexFaces& around, std::vector<Index> faces,
                              int rings) {
  sort_unique(faces);
  for (int ring = 0; ring < rings; ++ring) {
    for (const Index v : vertices_of(mesh, faces)) {
      faces.insert(faces.end(), around[v].begin(), around[v].end());
    }
    sort_unique(faces);
  }
  return faces;
}

}  // namespace meshgrain
