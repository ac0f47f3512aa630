#include "mesh/part.h"

#include <algorithm>

#include "mesh/vertex_faces.h"

namespace meshgrain {

Index Part::number(Index vertex) const {
  const auto at = std::ranges::lower_bound(vertices, vertex);
  const bool found = at != vertices.end() && *at == vertex;
  return found ? static_cast<Index>(at - vertices.begin()) : no_index;
}

Part part_of(const Mesh& whole, std::span<const Index> faces) {
  Part part{{}, vertices_of(whole, faces)};
  for (const Index v : part.vertices) part.mesh.positions.push_back(whole.positions[v]);
  std::vector<Index> corners;
  for (const Index f : faces) {
    corners.clear();
    for (const Index v : whole.faces[f]) corners.push_back(part.number(v));
    part.mesh.faces.push_back(corners);
  }
  return part;
}

}  // namespace meshgrain
