#include "meshgrain/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "made_points.h"

namespace meshgrain {
namespace {

/// Twice the area vector of a face.
Eigen::Vector3d area(const Mesh& mesh, std::size_t f) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto face = mesh.faces[f];
  for (std::size_t i = 0; i < face.size(); ++i)
    sum += mesh.positions[face[i]].cast<double>().cross(
        mesh.positions[face[(i + 1) % face.size()]].cast<double>());
  return sum;
}

std::size_t edges_of_more_than_two_faces(const Mesh& mesh) {
  std::map<std::pair<Index, Index>, int> count;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i)
      ++count[std::minmax({mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]})];
  std::size_t result = 0;
  for (const auto& [edge, faces] : count) result += faces > 2;
  return result;
}

TEST(Triangulate, TrianglesStayAsTheyAre) {
  Mesh mesh;
  mesh.positions.assign(4, Vec3::Zero());
  mesh.faces.push_back({3, 1, 2});
  mesh.faces.push_back({0, 1, 3});
  std::vector<Index> from;
  const Mesh result = triangulate(mesh, &from);
  EXPECT_EQ(from, (std::vector<Index>{0, 1}));
  EXPECT_EQ(result.faces[0][0], 3u);
  EXPECT_EQ(result.faces[1][2], 3u);
}

TEST(Triangulate, QuadTakesTheShorterDiagonal) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {3, 3, 0}, {0, 1, 0}};
  mesh.faces.push_back({0, 1, 2, 3});
  const Mesh result = triangulate(mesh);
  ASSERT_EQ(result.faces.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f) EXPECT_GT(area(result, f).z(), 0);
  EXPECT_EQ(result.faces[0][0], 1u);  // 1-3
}

TEST(Triangulate, ConcaveQuadIsSplitAtItsReflexCorner) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, -1, 0}, {0.5f, 0, 0}, {4, 1, 0}};
  for (Index turn = 0; turn < 4; ++turn)
    mesh.faces.push_back({turn, (turn + 1) % 4, (turn + 2) % 4, (turn + 3) % 4});
  for (Index turn = 0; turn < 4; ++turn) {
    Mesh one = mesh;
    one.faces.clear();
    one.faces.push_back(mesh.faces[turn]);
    const Mesh result = triangulate(one);
    EXPECT_LT(area(result, 0).z() * area(one, 0).z() * -1, 0);
    EXPECT_GT(area(result, 0).z() * area(result, 1).z(), 0);
  }
}

TEST(Triangulate, EarsFillAStarAndAComb) {
  for (const bool comb : {false, true}) {
    Mesh mesh;
    std::vector<Index> face;
    for (int i = 0; i < 60; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / 60;
      const float radius = i % 2 == 0 ? 1.0f : 0.3f;
      if (comb)
        mesh.positions.emplace_back(i < 59 ? i : 58,
                                    i == 59      ? -9
                                    : i % 2 == 0 ? 8
                                                 : 0.1f * static_cast<float>(i),
                                    3);
      else
        mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 3);
      face.push_back(static_cast<Index>(i));
    }
    if (comb) {
      mesh.positions.emplace_back(0, -9, 3);
      face.push_back(60);
    }
    mesh.faces.push_back(face);
    std::vector<Index> from;
    const Mesh result = triangulate(mesh, &from);
    ASSERT_EQ(result.faces.size(), face.size() - 2);
    EXPECT_EQ(from.size(), result.faces.size());
    const Eigen::Vector3d whole = area(mesh, 0);
    double sum = 0;
    for (std::size_t f = 0; f < result.faces.size(); ++f) {
      EXPECT_GE(area(result, f).dot(whole), 0);
      sum += area(result, f).norm();
    }
    EXPECT_NEAR(sum, whole.norm(), 1e-3);
  }
}

TEST(Triangulate, CollinearCornersMakeNoFlatTriangles) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};
  mesh.faces.push_back({0, 1, 2, 3, 4, 5});
  const Mesh result = triangulate(mesh);
  ASSERT_EQ(result.faces.size(), 4u);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_GT(area(result, f).z(), 0.5);
}

TEST(Triangulate, NeighboringPolygonsDoNotShareADiagonal) {
  // The two sides of a pillow, of the same corners: any diagonal of one repeated by the other would
  // be an edge of four triangles.
  for (const std::size_t n : {4u, 5u, 8u, 12u, 40u}) {
    Mesh mesh;
    std::vector<Index> face;
    for (std::size_t i = 0; i < n; ++i) {
      const float angle =
          2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(n);
      mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
      face.push_back(static_cast<Index>(i));
    }
    mesh.faces.push_back(face);
    mesh.faces.push_back(std::vector<Index>(face.rbegin(), face.rend()));
    const Mesh result = triangulate(mesh);
    EXPECT_EQ(result.faces.size(), 2 * (n - 2));
    EXPECT_EQ(edges_of_more_than_two_faces(result), 0u) << n << " corners";
  }
}

TEST(Triangulate, LargePolygonsTakeLittleTime) {
  Mesh mesh;
  std::vector<Index> face;
  for (Index i = 0; i < 20000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 20000;
    mesh.positions.emplace_back(Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>());
    face.push_back(i);
  }
  mesh.faces.push_back(face);
  EXPECT_EQ(triangulate(mesh).faces.size(), face.size() - 2);
}

TEST(Triangulate, AnyPolygonGivesAllItsTriangles) {
  Mesh mesh;
  for (std::uint64_t i = 0; i < 30; ++i)
    mesh.positions.emplace_back(made::noise(3 * i), made::noise(3 * i + 1), made::noise(3 * i + 2));
  mesh.faces.push_back({0, 1});
  mesh.faces.push_back({0, 1, 0, 1, 2});
  mesh.faces.push_back({5, 5, 5, 5, 5, 5});
  for (Index f = 0; f < 20; ++f) {
    std::vector<Index> face;
    for (Index i = 0; i < 4 + f % 5; ++i) face.push_back((f * 7 + i * 11) % 30);
    mesh.faces.push_back(face);
  }
  std::vector<Index> polygon;
  const Mesh triangles = triangulate(mesh, &polygon);
  ASSERT_EQ(polygon.size(), triangles.faces.size());
  for (std::size_t f = 3; f < mesh.faces.size(); ++f) {
    EXPECT_EQ(std::ranges::count(polygon, f) + 2, mesh.faces.degree(f));
  }
  // Of those that repeat vertices, the triangles that do not.
  for (std::size_t t = 0; t < triangles.faces.size(); ++t) {
    const auto face = triangles.faces[t];
    EXPECT_TRUE(face[0] != face[1] && face[1] != face[2] && face[2] != face[0]);
  }
  EXPECT_EQ(std::ranges::count(polygon, 1u), 1);
  EXPECT_EQ(std::ranges::count(polygon, 2u), 0);
}

}  // namespace
}  // namespace meshgrain
