#include "remesh/untie_knots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "extract/collect_faces.h"
#include "extract/knot_search.h"
#include "graph/vertex_graph.h"
#include "made_grid.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

constexpr Index cells = 12;

/// The halfedge between two vertices of a grid.
Index edge_between(const ExtractionMap& grid, Index a, Index b) {
  for (Index h = 0; h < grid.map.halfedges(); ++h) {
    if (grid.map.removed(h)) continue;
    if (grid.sources[grid.map.origin(h)] == a && grid.sources[grid.map.target(h)] == b) return h;
  }
  ADD_FAILURE() << "no such edge";
  return 0;
}

/// How many edges each vertex has too many; nothing is said of those of the border.
std::vector<int> excess_of(const ExtractionMap& grid) {
  std::vector<int> excess;
  for (Index v = 0; v < grid.map.vertices(); ++v) {
    const bool inside = !grid.clusters.on_border[v];
    excess.push_back(inside ? static_cast<int>(grid.map.valence(v)) - 4 : 0);
  }
  return excess;
}

std::size_t irregular(const std::vector<int>& excess) {
  return static_cast<std::size_t>(std::ranges::count_if(excess, [](int e) { return e != 0; }));
}

/// A grid some of whose edges, all in the middle, are turned.
Extraction turned_grid(const Mesh& plate, int turns, const Context& context) {
  const Extraction grid = made::grid_over(plate, cells);
  ExtractionMap parts(grid, context);
  FaceRepair repair(parts.map, parts.clusters, 4, parts.holes, parts.lines);
  const auto vertex = [](Index x, Index y) { return y * (cells + 1) + x; };
  for (int k = 0; k < turns; ++k) {
    const auto x = static_cast<Index>(5 + k % 3), y = static_cast<Index>(5 + k / 2);
    const Index h = edge_between(parts, vertex(x, y), vertex(x, y + 1));
    EXPECT_TRUE(repair.may_turn(h, 1));
    repair.apply({.h = h, .from = 1, .to = 4});
  }
  std::vector<Index> numbers;
  return collect_faces(parts.map, repair, parts.clusters, numbers, context);
}

TEST(KnotSearch, TurnsEdgesBack) {
  const Mesh plate = sample_shape("plate");
  const Context context;
  for (int turns = 1; turns <= 3; ++turns) {
    const ExtractionMap grid(turned_grid(plate, turns, context), context);
    const std::vector<int> excess = excess_of(grid);
    EXPECT_GE(irregular(excess), 4u);
    const std::vector<Untying> found = search_knot(grid, excess, 0, context);
    ASSERT_FALSE(found.empty()) << turns;
    EXPECT_EQ(found.front().irregular, 0u) << turns;
    for (const KnotStep& step : found.front().steps) EXPECT_FALSE(step.closes());
  }
}

TEST(KnotSearch, LeavesWhatIsRegular) {
  const Context context;
  const ExtractionMap grid(made::grid_over(sample_shape("plate"), cells), context);
  EXPECT_TRUE(search_knot(grid, excess_of(grid), 10, context).empty());
}

TEST(UntieKnots, LeavesARegularGrid) {
  const Mesh plate = sample_shape("plate");
  const Context context;
  const VertexFaces around = vertex_faces(plate, context);
  const Graph graph = vertex_graph(plate, around, {}, context);
  Extraction quads = turned_grid(plate, 3, context);
  const MeshStatistics before = mesh_statistics(quads.mesh);
  EXPECT_GE(before.irregular_vertices, 4u);
  untie_knots(quads, plate, around, graph, {}, 0, 1, context);
  const MeshStatistics after = mesh_statistics(quads.mesh);
  EXPECT_EQ(after.irregular_vertices, 0u);
  EXPECT_EQ(quads.mesh.faces.size(), std::size_t{cells} * cells);
  EXPECT_GT(after.jacobian_min, 0.9);
  made::expect_same_topology(after, before);
}

/// Pieces are smoothed on many threads at once.
TEST(UntieKnots, PiecesDoNotTellOfProgress) {
  const Mesh plate = sample_shape("plate");
  Context context;
  int told = 0;
  context.on_progress = [&](std::string_view, double) { ++told; };
  const VertexFaces around = vertex_faces(plate, context);
  const Graph graph = vertex_graph(plate, around, {}, context);
  Extraction quads = turned_grid(plate, 3, context);
  told = 0;
  untie_knots(quads, plate, around, graph, {}, 0, 1, context);
  EXPECT_EQ(mesh_statistics(quads.mesh).irregular_vertices, 0u);
  EXPECT_EQ(told, 0);
}

}  // namespace
}  // namespace meshgrain
