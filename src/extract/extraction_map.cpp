#include "extract/extraction_map.h"

#include <array>
#include <map>

#include "extract/line_edges.h"
#include "util/edge_of.h"

namespace meshgrain {

ExtractionMap::ExtractionMap(const Extraction& extraction, const Context& context) {
  const Mesh& mesh = extraction.mesh;
  map = PolygonMap(mesh, sources, corners, context);
  holes.resize(map.halfedges());
  for (Index h = 0; h < map.halfedges(); ++h) holes[h] = corners[h] == no_index;
  const std::vector<std::uint8_t> hold = held_vertices(extraction);
  for (const Index v : sources) {
    clusters.positions.push_back(mesh.positions[v]);
    clusters.normals.push_back(mesh.normals[v]);
    clusters.nodes.push_back(extraction.nodes[v]);
    clusters.hold.push_back(hold[v]);
  }
  clusters.on_border.assign(sources.size(), 0);
  for (Index h = 0; h < map.halfedges(); ++h) {
    if (holes[h]) clusters.on_border[map.origin(h)] = 1;
  }
  std::map<std::array<Index, 2>, Index> line_of;
  for (const auto& [a, b, line] : extraction.line_edges) line_of[edge_of(a, b)] = line;
  lines.assign(map.halfedges() / 2, no_index);
  for (Index e = 0; e < lines.size(); ++e) {
    const auto it = line_of.find(edge_of(sources[map.origin(2 * e)], sources[map.target(2 * e)]));
    if (it != line_of.end()) lines[e] = it->second;
  }
}

}  // namespace meshgrain
