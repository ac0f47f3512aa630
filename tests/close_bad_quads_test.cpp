#include "remesh/close_bad_quads.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "graph/vertex_graph.h"
#include "made_grid.h"
#include "meshgrain/features.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// At a straight border one of two quads has three corners in a row, which no vertex can mend: an
/// edge between the two turns back, no face goes, and nothing else is left of the piece they were
/// in.
TEST(CloseBadQuads, TurnsAnEdgeBackAtAStraightBorder) {
  const Mesh plate = sample_shape("plate");
  const Context context;
  const VertexFaces around = vertex_faces(plate, context);
  const Graph graph = vertex_graph(plate, around, {}, context);
  constexpr Index cells = 8;
  Extraction quads = made::grid_over(plate, cells);
  // Of the two faces in the middle of the lower border.
  constexpr Index a = cells / 2 - 1, row = cells + 1;
  Faces faces;
  for (Index f = 0; f < cells * cells; ++f) {
    if (f == a) {
      faces.push_back(std::array{a, a + 1, a + 2, a + 2 + row});
    } else if (f == a + 1) {
      faces.push_back(std::array{a, a + 2 + row, a + 1 + row, a + row});
    } else {
      faces.push_back(std::as_const(quads.mesh.faces)[f]);
    }
  }
  quads.mesh.faces = std::move(faces);
  const MeshStatistics before = mesh_statistics(quads.mesh);
  ASSERT_LT(before.jacobian_min, 0.01);
  SmoothOptions smoothing;
  close_bad_quads(quads, plate, around, graph, smoothing, 10, context);
  const MeshStatistics after = mesh_statistics(quads.mesh);
  made::expect_same_topology(after, before);
  EXPECT_EQ(after.faces, before.faces);
  EXPECT_EQ(after.vertices, before.vertices);
  EXPECT_GT(after.jacobian_min, 0.5);
}

}  // namespace
}  // namespace meshgrain
