#include "meshgrain/extract.h"

#include <algorithm>
#include <utility>

#include "extract/cancel_singularities.h"
#include "extract/collect_faces.h"
#include "extract/drop_unused.h"
#include "extract/face_repair.h"
#include "extract/graph_clusters.h"
#include "extract/join_pieces.h"
#include "extract/lattice_mesh.h"
#include "extract/lattice_repair.h"
#include "extract/mesh_clusters.h"
#include "extract/open_strips.h"
#include "extract/pair_odd_faces.h"
#include "extract/polygon_map.h"
#include "graph/pieces.h"
#include "mesh/pieces.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

/// Whether each of `edges` is among `chosen` (both sorted).
std::vector<std::uint8_t> mark(const std::vector<std::array<Index, 2>>& edges,
                               const std::vector<std::array<Index, 2>>& chosen) {
  std::vector<std::uint8_t> result(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    result[e] = std::binary_search(chosen.begin(), chosen.end(), edges[e]);
  }
  return result;
}

/// Drops what broke off: parts of a few faces that are not the largest of their part of the graph.
/// They come from contradictions between integers, not from the input.
void drop_fragments(Extraction& extraction, const Graph& graph, const Context& context) {
  constexpr std::size_t fragment = 8;  // faces
  Mesh& mesh = extraction.mesh;
  UnionFind output = pieces_of(mesh);
  SharedUnionFind input = pieces_of(graph, context);
  std::vector<std::size_t> size(mesh.positions.size(), 0), largest(graph.size(), 0);
  const auto part_of = [&](std::size_t f) { return output.find(std::as_const(mesh.faces)[f][0]); };
  const auto source_of = [&](Index part) { return input.find(extraction.nodes[part]); };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) ++size[part_of(f)];
  for (Index v = 0; v < size.size(); ++v) {
    largest[source_of(v)] = std::max(largest[source_of(v)], size[v]);
  }
  Faces kept;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Index part = part_of(f);
    if (size[part] > fragment || size[part] == largest[source_of(part)]) {
      kept.push_back(std::as_const(mesh.faces)[f]);
    }
  }
  if (kept.size() == mesh.faces.size()) return;
  mesh.faces = std::move(kept);
  drop_unused(extraction);
}

/// The local changes that leave fewer irregular faces and vertices.
void make_regular(FaceRepair& repair, int posy, const Context& context) {
  if (posy == 4) {
    repair.improve_edges(context);
    repair.close_quads(context);
    repair.open_vertices();
    repair.improve_edges(context);
    repair.remove_doublets();
  } else {
    repair.flip_edges(context);
  }
}

/// The paper's way: clusters of the graph, and faces found by walking around them.
Extraction extract_from_graph(const Graph& graph, const OrientationField& orientation,
                              const PositionField& position, const ExtractOptions& options,
                              const Context& context) {
  auto [clusters, edges, border] = collapse_graph(graph, orientation, position, options, context);
  PolygonMap map(clusters.positions, clusters.normals, edges);
  clusters.hold.assign(clusters.positions.size(), free_vertex);
  FaceRepair repair(map, clusters, position.posy, std::vector<std::uint8_t>(map.halfedges(), 0),
                    std::vector<Index>(map.halfedges() / 2, no_index));
  repair.remove_dangling();
  repair.cut_pinches();
  repair.find_holes(mark(edges, border), clusters.on_border, options.largest_filled_gap);
  repair.split_large();
  make_regular(repair, position.posy, context);
  std::vector<Index> vertex;
  Extraction result = collect_faces(map, repair, clusters, vertex, context);
  drop_fragments(result, graph, context);
  return result;
}

/// The way over the mesh itself, which keeps its topology.
Extraction extract_from_mesh(const Graph& graph, const OrientationField& orientation,
                             const PositionField& position, const ExtractOptions& options,
                             const Context& context) {
  FeatureLines border;
  if (options.features == nullptr) {
    border = find_features(*options.surface, {.creases = Creases::none, .align_border = false},
                           position.edge_length[0], context);
  }
  const FeatureLines& features = options.features != nullptr ? *options.features : border;
  CollapsedMesh collapsed = collapse_mesh(*options.surface, options.sources, features, graph,
                                          orientation, position, options.energy, context);
  const std::vector<Index> same_line = lines_before_cut(features, options.sources);
  collapsed.lattice.line_stays = lines_of_cut(same_line);
  LatticeMesh lattice(std::move(collapsed.lattice), std::move(collapsed.clusters), collapsed.roots,
                      graph, orientation, position, options.keeps_singularities);
  open_strips(lattice);
  repair_lattice(lattice, context);
  cancel_position_singularities(
      lattice, {options.cancelling_cost, options.cancelling_cost_where_graded}, context);
  repair_lattice(lattice, context);
  lattice.clusters.hold = std::move(lattice.hold);
  FaceRepair repair(lattice.map, lattice.clusters, position.posy, std::move(lattice.holes),
                    std::move(lattice.lines));
  if (position.posy == 4) repair.remove_diagonals(lattice.jumps, context);
  repair.part_straight_angles();
  make_regular(repair, position.posy, context);
  if (options.only_quads) {
    pair_odd_faces(lattice.map, repair, context);
    make_regular(repair, position.posy, context);
  }
  std::vector<Index> vertex;
  Extraction result = collect_faces(lattice.map, repair, lattice.clusters, vertex, context);
  // Quads that are still to be split may be pentagons.
  const std::size_t most_corners = position.posy == 6 ? 3 : options.only_quads ? 4 : 5;
  if (!options.manifold && !collapsed.meetings.empty()) {
    join_pieces(result, collapsed.meetings, vertex, same_line, most_corners, context);
  }
  return result;
}

}  // namespace

Extraction extract_mesh(const Graph& graph, const OrientationField& orientation,
                        const PositionField& position, const ExtractOptions& options,
                        const Context& context) {
  context.progress("extraction", 0);
  Extraction result = options.surface != nullptr
                          ? extract_from_mesh(graph, orientation, position, options, context)
                          : extract_from_graph(graph, orientation, position, options, context);
  context.progress("extraction", 1);
  return result;
}

}  // namespace meshgrain
