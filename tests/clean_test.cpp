#include "meshgrain/clean.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mesh/border.h"
#include "meshgrain/shapes.h"
#include "meshgrain/surface.h"
#include "meshgrain/triangulate.h"

namespace meshgrain {
namespace {

Mesh vertices(int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    mesh.positions.emplace_back(i, i * i, 0);
    mesh.values.push_back(static_cast<float>(i));
  }
  return mesh;
}

TEST(Clean, LeavesACleanMeshAlone) {
  Mesh mesh = vertices(4);
  mesh.faces.push_back({0, 1, 2});
  mesh.faces.push_back({2, 1, 3});
  EXPECT_FALSE(clean(mesh).any());
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.faces.size(), 2u);
}

TEST(Clean, RemovesRepeatedCorners) {
  Mesh mesh = vertices(4);
  mesh.faces.push_back({0, 1, 1, 2, 3, 0});
  const CleanReport report = clean(mesh);
  EXPECT_EQ(report.repeated_corners, 2u);
  EXPECT_EQ(report.degenerate_faces, 0u);
  ASSERT_EQ(mesh.faces.degree(0), 4u);
  EXPECT_EQ(mesh.faces[0][1], 1u);
  EXPECT_EQ(mesh.faces[0][2], 2u);
}

TEST(Clean, RemovesSpikesOfFaces) {
  Mesh mesh = vertices(6);
  mesh.faces.push_back({4, 0, 1, 2, 3, 2, 0});
  mesh.faces.push_back({0, 1, 0, 5, 2, 0});
  EXPECT_EQ(clean(mesh).repeated_corners, 7u);
  ASSERT_EQ(mesh.faces.size(), 2u);
  for (const std::size_t f : {0, 1}) {
    std::vector<Index> face(mesh.faces[f].begin(), mesh.faces[f].end());
    std::ranges::sort(face);
    EXPECT_EQ(face, f == 0 ? std::vector<Index>({0, 1, 2}) : std::vector<Index>({0, 2, 3}));
  }
}

/// One large spike within the face, and many small ones: a file may hold them.
TEST(Clean, ManySpikesTakeLittleTime) {
  constexpr Index count = 400000;
  Mesh mesh;
  mesh.positions.resize(count, Vec3::Zero());
  std::vector<Index> there_and_back, star;
  for (Index v = 0; v < count; ++v) {
    there_and_back.push_back(v);
    star.insert(star.end(), {0, v});
  }
  for (Index v = count - 1; v-- > 1;) there_and_back.push_back(v);
  mesh.faces.push_back(there_and_back);
  mesh.faces.push_back(star);
  EXPECT_EQ(clean(mesh).degenerate_faces, 2u);
}

/// A square with a square hole, and an edge that joins the two.
TEST(Clean, PolygonsWithHolesStayWhole) {
  Mesh mesh;
  for (const float half : {2.0f, 1.0f}) {
    mesh.positions.push_back({-half, -half, 0});
    mesh.positions.push_back({half, -half, 0});
    mesh.positions.push_back({half, half, 0});
    mesh.positions.push_back({-half, half, 0});
  }
  mesh.faces.push_back({0, 1, 2, 3, 0, 4, 7, 6, 5, 4});
  EXPECT_FALSE(clean(mesh).any());
  const Mesh triangles = triangulate(mesh);
  EXPECT_EQ(triangles.faces.size(), 8u);
  EXPECT_NEAR(surface_area(triangles), 12, 1e-4);
  EXPECT_EQ(border_edges(triangles).size(), 8u);
}

TEST(Clean, RemovesDegenerateFaces) {
  Mesh mesh = vertices(5);
  mesh.faces.push_back({0, 1, 0});
  mesh.faces.push_back({1, 2});
  mesh.faces.push_back({0, 1, 2, 1});
  mesh.faces.push_back({3, 3, 3});
  mesh.faces.push_back({0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3});
  mesh.faces.push_back({0, 1, 2});
  const CleanReport report = clean(mesh);
  EXPECT_EQ(report.degenerate_faces, 5u);
  EXPECT_EQ(report.unused_vertices, 2u);
  EXPECT_EQ(mesh.faces.size(), 1u);
  EXPECT_EQ(mesh.positions.size(), 3u);
}

/// Fans of many faces around the lowest vertex, which all have the same lowest corner.
TEST(Clean, FindsDuplicatesAmongManyFacesAroundAVertex) {
  Mesh mesh;
  constexpr Index count = 100000;
  mesh.positions.resize(count + 2, Vec3::Zero());
  for (Index v = 1; v <= count; ++v) mesh.faces.push_back(std::array<Index, 3>{0, v, v + 1});
  for (Index v = 1; v <= count; v += 1000) mesh.faces.push_back(std::array<Index, 3>{v + 1, v, 0});
  EXPECT_EQ(clean(mesh).duplicate_faces, 100u);
  EXPECT_EQ(mesh.faces.size(), count);
}

TEST(Clean, RemovesDuplicateFacesInAnyRotationAndDirection) {
  Mesh mesh = vertices(5);
  mesh.faces.push_back({0, 1, 2, 3});
  mesh.faces.push_back({2, 3, 0, 1});
  mesh.faces.push_back({3, 2, 1, 0});
  mesh.faces.push_back({0, 2, 1, 3});  // the same vertices, another quad
  mesh.faces.push_back({0, 1, 2});
  mesh.faces.push_back({1, 0, 2});
  mesh.faces.push_back({2, 3, 4});
  const CleanReport report = clean(mesh);
  EXPECT_EQ(report.duplicate_faces, 3u);
  ASSERT_EQ(mesh.faces.size(), 4u);
  EXPECT_EQ(mesh.faces[1][1], 2u);
  EXPECT_EQ(mesh.faces[3][2], 4u);
}

/// In the order of their lowest corners, as after sorting along a curve, they are found in another
/// way.
TEST(Clean, FindsDuplicatesInAnyOrderOfFaces) {
  Mesh mesh = sample_shape("blob");
  sort_along_curve(mesh);
  ASSERT_GT(mesh.faces.size(), 4000u);  // several of the ranges that are looked at in parallel
  const Faces once = std::exchange(mesh.faces, {});
  std::size_t more = 0;
  for (std::size_t f = 0; f < once.size(); ++f) {
    const auto face = std::as_const(once)[f];
    mesh.faces.push_back(face);
    if (f % 7 > 0) continue;
    mesh.faces.push_back(std::array{face[1], face[2], face[0]});
    ++more;
  }
  Mesh shuffled = mesh;
  shuffled.faces = {};
  constexpr std::size_t stride = 7919;  // a prime
  ASSERT_NE(mesh.faces.size() % stride, 0u);
  for (std::size_t k = 0; k < mesh.faces.size(); ++k) {
    shuffled.faces.push_back(std::as_const(mesh.faces)[k * stride % mesh.faces.size()]);
  }
  for (Mesh* const with_duplicates : {&mesh, &shuffled}) {
    EXPECT_EQ(clean(*with_duplicates).duplicate_faces, more);
    EXPECT_EQ(with_duplicates->faces.size(), once.size());
    EXPECT_TRUE(rim_edges(*with_duplicates).empty());
  }
  EXPECT_TRUE(std::ranges::equal(mesh.faces.corners(), once.corners()));
}

/// Ranges are looked at in parallel: a pair may lie on both sides of where they meet.
TEST(Clean, FindsTheOnlyDuplicateWhereverItIs) {
  Mesh mesh = sample_shape("blob");
  sort_along_curve(mesh);
  for (std::size_t place = 1000; place < 1050; ++place) {
    Mesh with_one = mesh;
    with_one.faces = {};
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = std::as_const(mesh.faces)[f];
      with_one.faces.push_back(face);
      if (f == place) with_one.faces.push_back(std::array{face[1], face[2], face[0]});
    }
    EXPECT_EQ(clean(with_one).duplicate_faces, 1u) << place;
  }
}

TEST(Clean, AttributesFollowTheirVertices) {
  Mesh mesh = vertices(6);
  mesh.faces.push_back({1, 3, 5});
  EXPECT_EQ(clean(mesh).unused_vertices, 3u);
  EXPECT_EQ(mesh.values, (std::vector<float>{1, 3, 5}));
  EXPECT_EQ(mesh.positions[2].x(), 5);
  EXPECT_EQ(mesh.faces[0][2], 2u);
}

TEST(Clean, NothingIsLeftOfOnlyDegenerateFaces) {
  Mesh mesh = vertices(3);
  mesh.faces.push_back({0, 1, 1});
  clean(mesh);
  EXPECT_TRUE(mesh.positions.empty());
  EXPECT_TRUE(mesh.faces.empty());
}

/// Adds a triangle with two sides that stands on an edge of the mesh.
void add_fin(Mesh& mesh, float height) {
  const auto face = std::as_const(mesh.faces)[0];
  const Index a = face[0], b = face[1], top = static_cast<Index>(mesh.positions.size());
  const Vec3 middle = (mesh.positions[a] + mesh.positions[b]) / 2;
  mesh.positions.push_back(middle * (1 + height));
  mesh.faces.push_back({a, b, top});
  mesh.faces.push_back({top, b, a});
}

TEST(Clean, RemovesBothSidesOfSmallFins) {
  const Mesh sphere = sample_shape("sphere");
  Mesh mesh = sphere;
  add_fin(mesh, 0.1f);
  const CleanReport report = clean(mesh);
  EXPECT_EQ(report.fin_faces, 2u);
  EXPECT_EQ(report.duplicate_faces, 0u);
  EXPECT_EQ(report.unused_vertices, 1u);
  EXPECT_TRUE(std::ranges::equal(mesh.faces.corners(), sphere.faces.corners()));
  EXPECT_EQ(mesh.positions, sphere.positions);
}

/// Else nothing would be left of what is meant to have no thickness.
TEST(Clean, KeepsOneSideOfLargeFinsAndOfSheets) {
  Mesh mesh = sample_shape("sphere");
  const std::size_t faces = mesh.faces.size();
  add_fin(mesh, 30);
  EXPECT_EQ(clean(mesh).fin_faces, 0u);
  EXPECT_EQ(mesh.faces.size(), faces + 1);

  Mesh sheet = sample_shape("plate");
  const Faces one_side = sheet.faces;
  for (std::size_t f = 0; f < one_side.size(); ++f) {
    std::vector<Index> face(one_side[f].rbegin(), one_side[f].rend());
    sheet.faces.push_back(face);
  }
  const CleanReport report = clean(sheet);
  EXPECT_EQ(report.fin_faces, 0u);
  EXPECT_EQ(report.duplicate_faces, one_side.size());
  EXPECT_TRUE(std::ranges::equal(sheet.faces.corners(), one_side.corners()));
}

TEST(Clean, RemovesDuplicatePointsOfACloud) {
  Mesh cloud = vertices(4);
  cloud.positions[2] = cloud.positions[0];
  cloud.positions[0].z() = -0.0f;
  const CleanReport report = clean(cloud);
  EXPECT_EQ(report.duplicate_points, 1u);
  EXPECT_EQ(cloud.values, (std::vector<float>{0, 1, 3}));
}

TEST(DropSmallPieces, KeepsTheLargestAndWhatIsLargeEnough) {
  Mesh mesh;
  for (const float size : {1.0f, 3.0f, 2.0f}) {  // areas 0.5, 4.5, 2
    const auto first = static_cast<Index>(mesh.positions.size());
    const Vec3 corner(10 * size, 0, 0);
    mesh.positions.insert(mesh.positions.end(),
                          {corner, corner + Vec3(size, 0, 0), corner + Vec3(0, size, 0)});
    mesh.faces.push_back(std::array<Index, 3>{first, first + 1, first + 2});
  }
  Mesh some = mesh, all = mesh;
  EXPECT_EQ(drop_small_pieces(mesh, 0.4), 0u);
  EXPECT_EQ(mesh.faces.size(), 3u);
  EXPECT_EQ(drop_small_pieces(some, 1), 1u);
  EXPECT_EQ(some.positions.size(), 6u);
  EXPECT_EQ(some.positions[std::as_const(some.faces)[0][0]], Vec3(30, 0, 0));
  EXPECT_EQ(drop_small_pieces(all, 100), 2u);
  EXPECT_EQ(all.faces.size(), 1u);
}

}  // namespace
}  // namespace meshgrain
