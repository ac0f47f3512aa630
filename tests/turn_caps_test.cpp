#include "mesh/turn_caps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "measure/face_shape.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/triangulate.h"
#include "same_topology.h"

namespace meshgrain {
namespace {

/// Divides an edge of some faces, for one of its two sides alone: a triangle without area is what
/// joins that to the other side. Returns how many there are.
std::size_t add_caps(Mesh& mesh, std::size_t every, unsigned parts) {
  std::size_t count = 0;
  const std::size_t faces = mesh.faces.size();
  for (std::size_t f = 0; f < faces; f += every) {
    const std::array<Index, 3> t{mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2]};
    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]];
    std::vector<Index> on{t[0]};
    for (unsigned k = 1; k < parts; ++k) {
      on.push_back(static_cast<Index>(mesh.positions.size()));
      mesh.positions.push_back(a + (b - a) * (static_cast<float>(k) / static_cast<float>(parts)));
    }
    on.push_back(t[1]);
    mesh.faces[f][1] = on[1];
    for (unsigned k = 1; k < parts; ++k) {
      mesh.faces.push_back({on[k], on[k + 1], t[2]});
      mesh.faces.push_back({on[0], on[k + 1], on[k]});
      ++count;
    }
  }
  return count;
}

double least_area(const Mesh& mesh) {
  double least = 1;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    least = std::min(least, static_cast<double>(area_vector(mesh.faces[f], mesh.positions).norm()));
  }
  return least;
}

Mesh sphere() {
  return triangulate(sample_shape("sphere", 0.2));
}

TEST(TurnCaps, LeavesNoTriangleWithoutArea) {
  for (const unsigned parts : {2u, 5u}) {
    Mesh mesh = sphere();
    const MeshStatistics before = mesh_statistics(mesh);
    const double area = least_area(mesh);
    const std::size_t caps = add_caps(mesh, 7, parts);
    const std::size_t vertices = mesh.positions.size();
    ASSERT_LT(least_area(mesh), 1e-6 * area);
    EXPECT_GE(turn_caps(mesh, Context(1)), caps);
    made::expect_same_topology(mesh_statistics(mesh), before);
    EXPECT_EQ(mesh.positions.size(), vertices);
    EXPECT_GT(least_area(mesh), 0.02 * area);
  }
}

TEST(TurnCaps, LeavesOtherMeshesAlone) {
  Mesh mesh = sphere();
  const Mesh before = mesh;
  EXPECT_EQ(turn_caps(mesh, Context(1)), 0u);
  EXPECT_TRUE(std::ranges::equal(mesh.faces.corners(), before.faces.corners()));
}

TEST(TurnCaps, MarksGoOnAlongTheOtherEdges) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {1, -1, 0}};
  for (const auto& face : {std::array<Index, 3>{0, 3, 2}, {3, 1, 2}, {0, 1, 3}, {1, 0, 4}}) {
    mesh.faces.push_back({face[0], face[1], face[2]});
  }
  mesh.marked_edges = {{0, 1}, {1, 2}};
  EXPECT_EQ(turn_caps(mesh, Context(1)), 1u);
  const std::vector<std::array<Index, 2>> expected{{0, 3}, {1, 2}, {1, 3}};
  std::vector<std::array<Index, 2>> marks;
  for (const auto& [a, b] : mesh.marked_edges) marks.push_back({std::min(a, b), std::max(a, b)});
  std::ranges::sort(marks);
  EXPECT_EQ(marks, expected);
}

TEST(TurnCaps, FinsWithoutAreaGo) {
  Mesh mesh = sphere();
  const MeshStatistics before = mesh_statistics(mesh);
  for (std::size_t f = 0; f < 5; ++f) {
    const Index a = mesh.faces[9 * f][0], b = mesh.faces[9 * f][1];
    mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
    mesh.faces.push_back({a, b, static_cast<Index>(mesh.positions.size() - 1)});
  }
  ASSERT_EQ(mesh_statistics(mesh).non_manifold_edges, 5u);
  EXPECT_EQ(turn_caps(mesh, Context(1)), 5u);
  EXPECT_EQ(mesh.positions.size(), before.vertices);
  made::expect_same_topology(mesh_statistics(mesh), before);
}

/// As CAD programs write them where an edge meets the middle of another.
TEST(TurnCaps, FacesOverThemAreAsRegularAsWithout) {
  Mesh mesh = sphere();
  RemeshOptions options;
  options.face_count = 2000;
  const MeshStatistics whole = mesh_statistics(remesh(mesh, options).mesh);
  add_caps(mesh, 5, 3);
  const RemeshResult result = remesh(mesh, options);
  const MeshStatistics now = mesh_statistics(result.mesh);
  EXPECT_TRUE(result.report.notes.empty());
  EXPECT_LE(now.singularities, whole.singularities + 8);
  EXPECT_LT(now.angle_sigma, 1.1 * whole.angle_sigma);
  EXPECT_EQ(now.inverted_quads, 0u);
}

}  // namespace
}  // namespace meshgrain
