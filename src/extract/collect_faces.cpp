#include "extract/collect_faces.h"

#include <algorithm>

namespace meshgrain {

Extraction collect_faces(const PolygonMap& map, const FaceRepair& repair, const Clusters& clusters,
                         std::vector<Index>& vertex) {
  Extraction result;
  vertex.assign(clusters.positions.size(), no_index);
  std::vector<std::uint8_t> seen(map.halfedges(), 0);
  std::vector<Index> orbit, face;
  for (Index h = 0; h < map.halfedges(); ++h) {
    if (map.removed(h) || seen[h]) continue;
    map.orbit(h, orbit);
    for (const Index g : orbit) seen[g] = 1;
    if (repair.is_hole(h) || orbit.size() < 3) continue;
    face.clear();
    for (const Index g : orbit) face.push_back(map.origin(g));
    std::sort(face.begin(), face.end());
    if (std::adjacent_find(face.begin(), face.end()) != face.end()) continue;
    face.clear();
    for (const Index g : orbit) {
      Index& v = vertex[map.origin(g)];
      if (v == no_index) {
        v = static_cast<Index>(result.mesh.positions.size());
        result.mesh.positions.push_back(clusters.positions[map.origin(g)]);
        result.mesh.normals.push_back(clusters.normals[map.origin(g)]);
        result.nodes.push_back(clusters.nodes[map.origin(g)]);
      }
      face.push_back(v);
    }
    result.mesh.faces.push_back(face);
  }
  for (Index h = 0; h < map.halfedges(); h += 2) {
    if (map.removed(h) || repair.line(h) == no_index) continue;
    const Index a = vertex[map.origin(h)], b = vertex[map.target(h)];
    if (a != no_index && b != no_index) result.line_edges.push_back({a, b, repair.line(h)});
  }
  for (std::size_t c = 0; c < vertex.size(); ++c) {
    if (vertex[c] != no_index && clusters.hold[c] == at_corner) {
      result.corners.push_back(vertex[c]);
    }
  }
  return result;
}

}  // namespace meshgrain
