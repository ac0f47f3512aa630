#include "finish/mend_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "finish/bad_places.h"
#include "made_grid.h"
#include "measure/crossings.h"
#include "meshgrain/graph.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"

namespace meshgrain {
namespace {

constexpr Index cells = 8;
constexpr Index at(Index x, Index y) {
  return y * (cells + 1) + x;
}

/// A square grid over a plate whose middle vertex has gone over those beside it.
struct FoldedGrid {
  Mesh plate = sample_shape("plate");
  Extraction grid = made::grid_over(plate, cells);
  VertexFaces around_plate = vertex_faces(plate);
  VertexFaces around = vertex_faces(grid.mesh);
  Graph graph = build_graph(plate);
  FeatureLines border =
      find_features(plate, {.creases = Creases::none, .align_border = false}, 0, Context());
  Placement placement{grid, plate, around_plate, graph, border};
  Index middle = at(4, 4);
  Vec3 home = grid.mesh.positions[middle];

  FoldedGrid() { grid.mesh.positions[middle] += Vec3(1.4f, 0.1f, 0) / cells; }
};

TEST(BadPlaces, CountWhatIsWrong) {
  FoldedGrid folded;
  LocalSearch search(folded.grid, folded.around, folded.placement, Context());
  BadPlaces places(folded.grid.mesh, folded.around, search, Context());
  places.demand({true, 0.1f});
  const auto bad = static_cast<std::size_t>(std::ranges::count_if(
      folded.around[folded.middle], [&](Index f) { return places.is_bad(f); }));
  ASSERT_GT(bad, 0u);

  const Index face = folded.around[folded.middle][0];
  BadPlace place = places.around(face, face, 2);
  EXPECT_EQ(place.faces.size(), 25u);
  EXPECT_EQ(place.vertices.size(), 16u);
  EXPECT_EQ(place.bad, bad);
  EXPECT_TRUE(std::ranges::binary_search(place.at_bad, folded.middle));
  EXPECT_TRUE(places.is_mended(place)) << "as it is now it may stay";

  --place.bad;
  EXPECT_FALSE(places.is_mended(place));
  EXPECT_EQ(places.wrong(place, 10), 1u);
  place.bad = 0;
  EXPECT_EQ(places.wrong(place, 10), bad);
  EXPECT_EQ(places.wrong(place, 1), 1u);

  search.put({{folded.middle}}, {{{folded.home, search.place(folded.middle).seed}}});
  EXPECT_EQ(places.wrong(place, 10), 0u);
}

TEST(MendPlaces, AFoldIsLaidFlat) {
  FoldedGrid folded;
  ASSERT_GT(mesh_statistics(folded.grid.mesh).inverted_quads, 0u);
  const Mesh before = folded.grid.mesh;
  LocalSearch search(folded.grid, folded.around, folded.placement, Context());
  mend_places(folded.grid.mesh, folded.around, folded.placement, search, SmoothOptions(),
              Context());
  EXPECT_EQ(mesh_statistics(folded.grid.mesh).inverted_quads, 0u);
  EXPECT_TRUE(find_crossings(folded.grid.mesh, Context()).empty());
  for (Index f = 0; f < folded.grid.mesh.faces.size(); ++f) EXPECT_GT(search.quality(f), 0.1f);
  for (const Index v : {at(0, 0), at(4, 0), at(8, 3), at(1, 8)}) {
    EXPECT_EQ(folded.grid.mesh.positions[v], before.positions[v]) << "far from it";
  }
}

}  // namespace
}  // namespace meshgrain
