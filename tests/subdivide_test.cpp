#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "made_graph.h"
#include "mesh/long_edges.h"
#include "mesh/refine_slivers.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

void refine(Mesh& mesh, double max_length) {
  const std::vector<Index> long_faces = faces_with_long_edges(mesh, max_length, Context());
  refine_slivers(mesh, max_length, long_faces, Context());
}

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

/// A cone without its bottom, of so many triangles from the rim to the tip.
Mesh cone_of(Index slivers) {
  Mesh cone;
  for (Index k = 0; k < slivers; ++k) {
    const double angle = 2 * std::numbers::pi * k / slivers;
    cone.positions.push_back(Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>());
    cone.faces.push_back({k, (k + 1) % slivers, slivers});
    cone.marked_edges.push_back({k, (k + 1) % slivers});
  }
  cone.positions.push_back(Vec3(0, 0, 2));
  cone.marked_edges.push_back({0, slivers});
  return cone;
}

TEST(RefineSlivers, FewVerticesServeACone) {
  const Mesh cone = cone_of(3000);
  constexpr double limit = 0.05;
  Mesh fine = cone;
  refine(fine, limit);
  EXPECT_LE(edge_lengths(fine).max, limit * (1 + 1e-5));
  Mesh plain = cone;
  subdivide(plain, limit);
  EXPECT_LT(5 * fine.positions.size(), plain.positions.size());
  EXPECT_LT(surface_distance(fine, cone, 1, 5000).max, 0.01 * limit);
  EXPECT_LT(surface_distance(cone, fine, 1, 5000).max, 0.01 * limit);
  const MeshStatistics s = mesh_statistics(fine);
  EXPECT_EQ(s.euler, 1);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.non_manifold_edges, 0u);
  EXPECT_EQ(s.non_manifold_vertices, 0u);
  EXPECT_EQ(s.isolated_vertices, 0u);
  const auto uses = edge_uses(fine);
  double marked = 0;
  for (const auto& [a, b] : fine.marked_edges) {
    EXPECT_TRUE(uses.contains(std::minmax(a, b)));
    marked += (fine.positions[b] - fine.positions[a]).norm();
  }
  EXPECT_NEAR(marked, 2 * std::numbers::pi + std::sqrt(5.0), 1e-3);
}

TEST(RefineSlivers, OthersAreLeftAlone) {
  const Mesh torus = made::shaken(sample_shape("torus", 0.2), 0.02f);
  Mesh fine = torus;
  refine(fine, 0.3 * edge_lengths(torus).mean);
  EXPECT_TRUE(std::ranges::equal(std::as_const(fine).faces.corners(), torus.faces.corners()));
  EXPECT_EQ(fine.positions.size(), torus.positions.size());
}

/// Three rows of slivers that meet in one edge get the same vertices on it.
TEST(RefineSlivers, NonManifoldEdgesStayJoined) {
  Mesh mesh;
  constexpr Index rows = 40;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  for (int wing = 0; wing < 3; ++wing) {
    const double angle = 2 * std::numbers::pi * wing / 3;
    Index a = 0, b = 1;
    for (Index row = 1; row <= rows; ++row) {
      const auto y = static_cast<float>(0.003 * row * std::cos(angle));
      const auto z = static_cast<float>(0.003 * row * std::sin(angle));
      const auto c = static_cast<Index>(mesh.positions.size()), d = c + 1;
      mesh.positions.push_back({0, y, z});
      mesh.positions.push_back({1, y, z});
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
      a = c;
      b = d;
    }
  }
  refine(mesh, 0.1);
  EXPECT_LE(edge_lengths(mesh).max, 0.1 * (1 + 1e-5));
  std::size_t borders = 0, triple = 0;
  for (const auto& [edge, count] : edge_uses(mesh)) {
    const bool on_axis = mesh.positions[edge.first].tail<2>().isZero() &&
                         mesh.positions[edge.second].tail<2>().isZero();
    EXPECT_EQ(count == 3, on_axis);
    EXPECT_LE(count, 3);
    triple += count == 3;
    borders += count == 1;
  }
  EXPECT_GE(triple, 10u);
  EXPECT_GE(borders, 3 * (10u + 2 * rows));
}

}  // namespace
}  // namespace meshgrain
