#include "extract/reduce_faces.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "extract/collect_faces.h"
#include "extract/face_repair.h"
#include "extract/line_edges.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

std::vector<Index> lines_of_edges(const Extraction& extraction, const PolygonMap& map) {
  std::map<std::array<Index, 2>, Index> lines;
  for (const auto& [a, b, line] : extraction.line_edges) {
    lines[edge_of(a, b)] = line;
  }
  std::vector<Index> result(map.halfedges() / 2, no_index);
  for (Index e = 0; e < result.size(); ++e) {
    const auto it = lines.find(edge_of(map.origin(2 * e), map.target(2 * e)));
    if (it != lines.end()) result[e] = it->second;
  }
  return result;
}

}  // namespace

std::size_t reduce_faces(Extraction& extraction, int posy, std::size_t count,
                         const Context& context) {
  const Mesh& mesh = extraction.mesh;
  std::vector<Index> sources;
  std::vector<std::uint8_t> holes;
  PolygonMap map(mesh, sources, holes, context);
  if (sources.size() != mesh.positions.size()) return 0;
  Clusters clusters;
  for (const Index v : sources) {
    clusters.positions.push_back(mesh.positions[v]);
    clusters.normals.push_back(mesh.normals[v]);
    clusters.nodes.push_back(extraction.nodes[v]);
  }
  clusters.on_border.assign(sources.size(), 0);
  for (Index h = 0; h < map.halfedges(); ++h) {
    if (holes[h]) clusters.on_border[map.origin(h)] = 1;
  }
  clusters.hold = held_vertices(extraction);
  FaceRepair repair(map, clusters, posy, std::move(holes), lines_of_edges(extraction, map));
  const std::size_t done = posy == 4 ? repair.close_quads(count) : repair.contract_edges(count);
  std::vector<Index> vertex;
  if (done > 0) extraction = collect_faces(map, repair, clusters, vertex);
  return done;
}

}  // namespace meshgrain
