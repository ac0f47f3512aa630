#include "extract/collect_faces.h"

#include <algorithm>

#include "util/collect.h"

namespace meshgrain {
namespace {

/// Whether h is the lowest halfedge of its orbit.
bool is_lowest(const PolygonMap& map, Index h) {
  Index g = map.next(h);
  while (g > h) g = map.next(g);
  return g == h;
}

/// The lowest halfedge of each orbit that is a face: no hole, and a simple polygon.
std::vector<Index> find_faces(const PolygonMap& map, const FaceRepair& repair,
                              const Context& context) {
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
    std::vector<Index> corners;
    for (auto h = static_cast<Index>(begin); h < end; ++h) {
      if (map.removed(h) || repair.is_hole(h) || !is_lowest(map, h)) continue;
      corners.clear();
      map.for_orbit(h, [&](Index g) { corners.push_back(map.origin(g)); });
      std::sort(corners.begin(), corners.end());
      const bool is_simple = std::adjacent_find(corners.begin(), corners.end()) == corners.end();
      if (corners.size() >= 3 && is_simple) out.push_back(h);
    }
  };
  return collect<Index>(map.halfedges(), look, context);
}

}  // namespace

Extraction collect_faces(const PolygonMap& map, const FaceRepair& repair, const Clusters& clusters,
                         std::vector<Index>& vertex, const Context& context) {
  Extraction result;
  vertex.assign(clusters.positions.size(), no_index);
  std::vector<Index> face;
  for (const Index h : find_faces(map, repair, context)) {
    face.clear();
    map.for_orbit(h, [&](Index g) {
      Index& v = vertex[map.origin(g)];
      if (v == no_index) {
        v = static_cast<Index>(result.mesh.positions.size());
        result.mesh.positions.push_back(clusters.positions[map.origin(g)]);
        result.mesh.normals.push_back(clusters.normals[map.origin(g)]);
        result.nodes.push_back(clusters.nodes[map.origin(g)]);
      }
      face.push_back(v);
    });
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
