#include <gtest/gtest.h>

#include <map>

#include "made_graph.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

/// How many faces have each edge.
std::map<std::pair<Index, Index>, int> edge_uses(const Mesh& mesh) {
  std::map<std::pair<Index, Index>, int> uses;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      ++uses[std::minmax(face[k], face[(k + 1) % face.size()])];
    }
  }
  return uses;
}

TEST(Subdivide, LeavesTheSurfaceAsItIs) {
  for (const char* name : {"bracket", "plate", "torus", "cube"}) {
    const Mesh coarse = made::shaken(sample_shape(name, 0.2), 0.02f);
    const EdgeLengths before = edge_lengths(coarse);
    for (const double factor : {2.0, 0.9, 0.4, 0.11}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(factor));
      Mesh fine = coarse;
      const double limit = factor * before.mean;
      subdivide(fine, limit);
      EXPECT_LE(edge_lengths(fine).max, limit * (1 + 1e-5));
      EXPECT_NEAR(surface_area(fine), surface_area(coarse), 1e-4 * surface_area(coarse));
      // The old vertices stay, and every new one lies on the old surface.
      for (std::size_t v = 0; v < coarse.positions.size(); ++v) {
        EXPECT_EQ(fine.positions[v], coarse.positions[v]);
      }
      EXPECT_LT(surface_distance(fine, coarse, 1, 2000).max, 1e-5);
      EXPECT_LT(surface_distance(coarse, fine, 1, 2000).max, 1e-5);
      const MeshStatistics old_statistics = mesh_statistics(coarse),
                           statistics = mesh_statistics(fine);
      EXPECT_EQ(statistics.euler, old_statistics.euler);
      EXPECT_EQ(statistics.non_manifold_edges, 0u);
      EXPECT_EQ(statistics.non_manifold_vertices, 0u);
      EXPECT_EQ(statistics.boundary_loops, old_statistics.boundary_loops);
      EXPECT_EQ(statistics.isolated_vertices, 0u);
      if (limit > before.max) {
        EXPECT_EQ(fine.faces.size(), coarse.faces.size());
      }
    }
  }
}

TEST(Subdivide, NonManifoldEdgesAreOrdinary) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  for (const Index apex : {2, 3, 4}) mesh.faces.push_back({0, 1, apex});
  const double area = surface_area(mesh);
  subdivide(mesh, 0.3);
  EXPECT_LE(edge_lengths(mesh).max, 0.3f * 1.00001);
  EXPECT_NEAR(surface_area(mesh), area, 1e-5);
  double length = 0;
  for (const auto& [edge, uses] : edge_uses(mesh)) {
    EXPECT_LE(uses, 3);
    if (uses == 3) length += (mesh.positions[edge.first] - mesh.positions[edge.second]).norm();
  }
  EXPECT_NEAR(length, 1, 1e-5);  // still one edge of three faces, in parts
}

TEST(Subdivide, InterpolatesNormalsAndValues) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {Vec3::UnitZ(), Vec3(1, 0, 1).normalized(), Vec3(0, 1, 1).normalized()};
  mesh.values = {0, 1, 2};
  mesh.faces.push_back({0, 1, 2});
  subdivide(mesh, 0.2);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.values.size(), mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_NEAR(mesh.values[v], mesh.positions[v].x() + 2 * mesh.positions[v].y(), 1e-5);
    EXPECT_NEAR(mesh.normals[v].norm(), 1, 1e-5);
  }
}

}  // namespace
}  // namespace meshgrain
