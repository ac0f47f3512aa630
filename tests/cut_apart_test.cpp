#include "mesh/cut_apart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "made_cells.h"
#include "mesh/border.h"
#include "mesh/pair_around_edge.h"
#include "meshgrain/statistics.h"
#include "meshgrain/triangulate.h"

namespace meshgrain {
namespace {

Mesh two_cubes() {
  return triangulate(made::surface_of_cells({{0, 0, 0}, {1, 1, 0}}));
}

TEST(CutApart, SolidsThatTouchBecomeWholePieces) {
  Mesh cubes = two_cubes();
  ASSERT_EQ(mesh_statistics(cubes).non_manifold_edges, 1u);
  const std::size_t before = cubes.positions.size();
  const Cuts cuts = cut_apart(cubes, Context());
  const MeshStatistics after = mesh_statistics(cubes);
  EXPECT_EQ(after.components, 2u);
  EXPECT_EQ(after.boundary_loops, 0u);
  EXPECT_EQ(after.non_manifold_edges, 0u);
  EXPECT_EQ(after.euler, 4);
  // Both cubes have the edge, with vertices of their own at the same places.
  EXPECT_EQ(cuts.edges.size(), 2u);
  ASSERT_EQ(cubes.positions.size(), before + 2);
  ASSERT_EQ(cuts.sources.size(), cubes.positions.size());
  for (std::size_t v = 0; v < cuts.sources.size(); ++v) {
    EXPECT_EQ(cubes.positions[v], cubes.positions[cuts.sources[v]]);
  }
}

TEST(CutApart, EverythingIsAsBeforeWhenItIsJoinedAgain) {
  Mesh cubes = two_cubes();
  for (std::size_t v = 0; v < cubes.positions.size(); ++v) {
    cubes.values.push_back(static_cast<float>(v));
  }
  const auto branches = branch_edges(cubes);
  ASSERT_EQ(branches.size(), 1u);
  // The edge itself, one that ends there, and one far away.
  const Index end = branches[0][0];
  const auto face = std::ranges::find(cubes.faces.corners(), end) - cubes.faces.corners().begin();
  const auto near = cubes.faces[static_cast<std::size_t>(face) / 3];
  cubes.marked_edges = {branches[0], {near[0], near[1]}};
  const Mesh before = cubes;
  const Cuts cuts = cut_apart(cubes, Context());
  EXPECT_EQ(mesh_statistics(cubes).marked_edges, cubes.marked_edges.size());
  EXPECT_GE(mesh_statistics(cubes).marked_edges, 2u);
  join_again(cubes, cuts);
  EXPECT_EQ(cubes.positions, before.positions);
  EXPECT_EQ(cubes.values, before.values);
  EXPECT_TRUE(std::ranges::equal(cubes.faces.corners(), before.faces.corners()));
  EXPECT_EQ(mesh_statistics(cubes).marked_edges, mesh_statistics(before).marked_edges);
}

TEST(CutApart, WhatIsManifoldStaysAsItIs) {
  Mesh cube = triangulate(made::surface_of_cells({{0, 0, 0}}));
  const std::size_t before = cube.positions.size();
  const Cuts cuts = cut_apart(cube, Context());
  EXPECT_TRUE(cuts.empty());
  EXPECT_EQ(cube.positions.size(), before);
}

/// The tube goes on past the disc, which is what gets a border.
TEST(CutApart, WhatLiesFlatStaysTogether) {
  Mesh tube = triangulate(made::tube_with_membrane());
  ASSERT_EQ(mesh_statistics(tube).boundary_loops, 2u);
  cut_apart(tube, Context());
  const MeshStatistics after = mesh_statistics(tube);
  EXPECT_EQ(after.components, 2u);
  EXPECT_EQ(after.boundary_loops, 3u);
  EXPECT_EQ(after.non_manifold_edges, 0u);
}

/// Boxes on either side of a wall that each have a face of it: at the same place, in any order.
TEST(CutApart, BoxesWithAWallBetweenThemHaveOneSideOfItEach) {
  const Vec3 left(-1, 0, 0), right(1, 0, 0), up(0, 1, 0);
  const Vec3 from(0, 0, 0), to(0, 0, 1);
  // Counterclockwise from the right: the right box is between `right` and `up`.
  std::vector<FaceBesideEdge> faces{{right, false}, {up, true}, {up, false}, {left, true}};
  std::ranges::sort(faces, {}, &FaceBesideEdge::runs_along);
  do {
    const auto pairs = pair_around_edge(from, to, faces);
    ASSERT_EQ(pairs.size(), 2u);
    for (const auto& [along, against] : pairs) {
      EXPECT_TRUE(faces[along].runs_along);
      EXPECT_FALSE(faces[against].runs_along);
      // At right angles: neither both sides of the wall, nor what is left and right of it.
      EXPECT_NEAR(faces[along].corner.dot(faces[against].corner), 0, 1e-6);
    }
  } while (std::ranges::next_permutation(faces, {}, [](const FaceBesideEdge& f) {
             return std::pair(f.corner.x() + 2 * f.corner.y(), f.runs_along);
           }).found);
}

}  // namespace
}  // namespace meshgrain
