#include "mesh/border.h"

#include "mesh/vertex_faces.h"

namespace meshgrain {

std::vector<std::array<Index, 2>> border_edges(const Mesh& mesh) {
  const VertexFaces around = vertex_faces(mesh);
  // How many faces around `a` have the edge between a and b, in either direction.
  const auto uses = [&](Index a, Index b) {
    int count = 0;
    for (const Index f : around[a]) {
      const auto face = mesh.faces[f];
      for (std::size_t k = 0; k < face.size(); ++k) {
        const Index v = face[k], w = face[k + 1 == face.size() ? 0 : k + 1];
        count += (v == a && w == b) || (v == b && w == a);
      }
    }
    return count;
  };
  std::vector<std::array<Index, 2>> result;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k], b = face[k + 1 == face.size() ? 0 : k + 1];
      if (uses(a, b) == 1) result.push_back({a, b});
    }
  }
  return result;
}

}  // namespace meshgrain
