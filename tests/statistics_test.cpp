#include "meshgrain/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "measure/bvh.h"
#include "meshgrain/error.h"
#include "meshgrain/shapes.h"
#include "meshgrain/surface.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

/// A flat grid of unit quads, but without the cells for which `hole` holds.
template <class Hole>
Mesh quad_grid(Index columns, Index rows, Hole&& hole) {
  Mesh mesh;
  for (Index j = 0; j <= rows; ++j)
    for (Index i = 0; i <= columns; ++i) mesh.positions.emplace_back(float(i), float(j), 0.0f);
  const auto at = [&](Index i, Index j) { return j * (columns + 1) + i; };
  for (Index j = 0; j < rows; ++j)
    for (Index i = 0; i < columns; ++i)
      if (!hole(i, j))
        mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

Mesh icosahedron() {
  const float g = std::numbers::phi_v<float>;
  Mesh mesh;
  for (float one : {-1.0f, 1.0f})
    for (float golden : {-g, g})
      for (int k = 0; k < 3; ++k) {
        Vec3 p = Vec3::Zero();
        p[k] = one, p[(k + 1) % 3] = golden;
        mesh.positions.push_back(p);
      }
  // Its faces: three corners two apart from each other.
  const auto adjacent = [&](Index a, Index b) {
    return std::abs((mesh.positions[a] - mesh.positions[b]).norm() - 2) < 0.01f;
  };
  for (Index a = 0; a < 12; ++a)
    for (Index b = a + 1; b < 12; ++b)
      for (Index c = b + 1; c < 12; ++c)
        if (adjacent(a, b) && adjacent(b, c) && adjacent(c, a)) mesh.faces.push_back({a, b, c});
  return mesh;
}

TEST(MeshStatistics, OfARegularGrid) {
  const auto s = mesh_statistics(quad_grid(5, 4, [](Index, Index) { return false; }));
  EXPECT_EQ(s.vertices, 30u);
  EXPECT_EQ(s.faces, 20u);
  EXPECT_EQ(s.quads, 20u);
  EXPECT_EQ(s.irregular_vertices, 0u);
  EXPECT_EQ(s.singularities, 0u);
  EXPECT_NEAR(s.area_sigma, 0, 1e-12);
  EXPECT_NEAR(s.angle_sigma, 0, 1e-6);
  EXPECT_NEAR(s.angle_min, 90, 1e-6);
  EXPECT_NEAR(s.angle_max_mean, 90, 1e-6);
  EXPECT_DOUBLE_EQ(s.edge_mean, 1);
  EXPECT_NEAR(s.edge_sigma, 0, 1e-12);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.euler, 1);
  EXPECT_EQ(s.inverted_quads, 0u);
  EXPECT_NEAR(s.jacobian_min, 1, 1e-6);
}

TEST(MeshStatistics, SkewedQuadsHaveTheSineOfTheirAngle) {
  Mesh mesh = quad_grid(15, 15, [](Index, Index) { return false; });
  mesh.positions.front() = {0.5f, 0.5f, 0};  // a corner of the first quad, which is now a triangle
  const auto s = mesh_statistics(mesh);
  EXPECT_NEAR(s.jacobian_min, 0, 1e-6);
  EXPECT_NEAR(s.jacobian_p01, 1, 1e-6);
  for (Vec3& p : mesh.positions) p.x() += p.y();
  EXPECT_NEAR(mesh_statistics(mesh).jacobian_p01, std::sqrt(0.5), 1e-6);
}

TEST(MeshStatistics, OfAPlateWithAHole) {
  Mesh mesh = quad_grid(5, 5, [](Index i, Index j) { return i > 0 && i < 4 && j > 0 && j < 4; });
  const auto s = mesh_statistics(mesh);
  EXPECT_EQ(s.boundary_loops, 2u);
  EXPECT_EQ(s.euler, 0);
  EXPECT_EQ(s.isolated_vertices, 4u);
  EXPECT_EQ(s.irregular_vertices, 0u);
}

TEST(MeshStatistics, OfACubeOfQuads) {
  Mesh mesh;
  for (int v = 0; v < 8; ++v)
    mesh.positions.emplace_back(float(v & 1), float(v >> 1 & 1), float(v >> 2));
  mesh.faces.push_back({0, 2, 3, 1});
  mesh.faces.push_back({4, 5, 7, 6});
  mesh.faces.push_back({0, 1, 5, 4});
  mesh.faces.push_back({2, 6, 7, 3});
  mesh.faces.push_back({0, 4, 6, 2});
  mesh.faces.push_back({1, 3, 7, 5});
  const auto s = mesh_statistics(mesh);
  EXPECT_EQ(s.irregular_vertices, 8u);
  EXPECT_EQ(s.singularities, 8u);
  EXPECT_EQ(s.euler, 2);
  EXPECT_EQ(s.boundary_loops, 0u);
  EXPECT_NEAR(bounding_diagonal(mesh), std::sqrt(3.0), 1e-6);
}

TEST(MeshStatistics, OfAnIcosahedron) {
  const auto s = mesh_statistics(icosahedron());
  EXPECT_EQ(s.vertices, 12u);
  EXPECT_EQ(s.triangles, 20u);
  EXPECT_EQ(s.irregular_vertices, 12u);
  EXPECT_NEAR(s.angle_min, 60, 1e-4);
  EXPECT_NEAR(s.angle_sigma, 0, 1e-4);
  EXPECT_NEAR(s.area_max, 1, 1e-5);
  EXPECT_NEAR(s.edge_mean, 2, 1e-5);
  EXPECT_EQ(s.euler, 2);
}

TEST(MeshStatistics, CountsPolygonsAsSingularities) {
  Mesh mesh = quad_grid(4, 4, [](Index i, Index j) { return i == 1 && j == 1; });
  mesh.faces.push_back({6, 7, 12});
  mesh.faces.push_back({6, 12, 11});
  const auto s = mesh_statistics(mesh);
  EXPECT_EQ(s.quads, 15u);
  EXPECT_EQ(s.triangles, 2u);
  EXPECT_EQ(s.irregular_vertices, 2u);
  EXPECT_EQ(s.singularities, 4u);
  EXPECT_NEAR(s.area_max * 17 / 16, 1.0 * 17 * 17 / 16 / 16, 1e-9);
}

TEST(MeshStatistics, SeesReflexAndFoldedQuads) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0.5f, 0.5f, 0}, {0, 2, 0}};
  mesh.faces.push_back({0, 1, 2, 3});
  const auto s = mesh_statistics(mesh);
  EXPECT_EQ(s.inverted_quads, 1u);
  EXPECT_NEAR(s.angle_max, 360 - 90 - 2 * s.angle_min, 1e-4);
}

TEST(MeshStatistics, FindsNonManifoldEdgesAndVertices) {
  Mesh book;  // three pages on one edge
  book.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  for (Index page = 2; page < 5; ++page) book.faces.push_back({0, 1, page});
  auto s = mesh_statistics(book);
  EXPECT_EQ(s.non_manifold_edges, 1u);
  EXPECT_EQ(s.non_manifold_vertices, 0u);

  Mesh bow;  // two triangles that touch at a vertex
  bow.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  bow.faces.push_back({0, 1, 2});
  bow.faces.push_back({0, 3, 4});
  s = mesh_statistics(bow);
  EXPECT_EQ(s.non_manifold_edges, 0u);
  EXPECT_EQ(s.non_manifold_vertices, 1u);
  EXPECT_EQ(s.components, 1u);
}

TEST(MeshStatistics, OfNothing) {
  const auto s = mesh_statistics(Mesh());
  EXPECT_EQ(s.vertices, 0u);
  EXPECT_EQ(s.euler, 0);
  EXPECT_EQ(s.area_sigma, 0);
  EXPECT_EQ(bounding_diagonal(Mesh()), 0);
}

TEST(ClosestPointOnTriangle, InsideOnEdgesAtCornersAndDegenerate) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const auto expect = [](const Vec3& found, const Vec3& expected) {
    EXPECT_LT((found - expected).norm(), 1e-6f) << found.transpose();
  };
  expect(closest_point_on_triangle({0.25f, 0.25f, 3}, a, b, c), {0.25f, 0.25f, 0});
  expect(closest_point_on_triangle({2, 2, 1}, a, b, c), {0.5f, 0.5f, 0});
  expect(closest_point_on_triangle({-1, -1, 0}, a, b, c), a);
  expect(closest_point_on_triangle({0.5f, -1, 0}, a, b, c), {0.5f, 0, 0});
  expect(closest_point_on_triangle({0.5f, 1, 0}, a, b, Vec3(0.3f, 0, 0)), {0.5f, 0, 0});
  expect(closest_point_on_triangle({0.5f, 1, 0}, b, b, b), b);
}

TEST(Bvh, AgreesWithTryingEveryTriangle) {
  const Mesh mesh = sample_shape("blob", 0.3);
  const Bvh tree(mesh);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(2 * std::sin(i), 1.5 * std::cos(2.3 * i), std::sin(0.7 * i + 1));
    double least = 1e9;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto corner = [&](int k) {
        return Eigen::Vector3d(mesh.positions[mesh.faces[f][k]].cast<double>());
      };
      const auto q = closest_point_on_triangle(p, corner(0), corner(1), corner(2));
      least = std::min(least, (q - p).squaredNorm());
    }
    EXPECT_NEAR(tree.closest(p).squared_distance, least, 1e-12);
    EXPECT_EQ(tree.closest(p, least / 2).triangle, no_index);
  }
}

TEST(SurfaceDistance, BetweenConcentricSpheres) {
  const Mesh inner = sample_shape("sphere", 3);
  Mesh outer = inner;
  for (Vec3& p : outer.positions) p *= 1.5f;
  EXPECT_NEAR(surface_distance(inner, outer, 1, 2000).mean, 0.5, 2e-3);
  EXPECT_NEAR(surface_distance(outer, inner, 1, 2000).max, 0.5, 2e-3);
  EXPECT_NEAR(surface_distance(outer, inner, 2, 2000).mean, 0.25, 1e-3);
  EXPECT_NEAR(surface_distance(inner, inner, 1, 2000).max, 0, 1e-6);
}

TEST(SurfaceDistance, OfCloudsAndShiftedOrigins) {
  Mesh cloud, plate = sample_shape("plate");
  for (float z : {0.25f, -0.5f, 1.0f}) cloud.positions.emplace_back(0.1f, 0.2f, z);
  const auto d = surface_distance(cloud, plate, 1);
  EXPECT_NEAR(d.mean, 1.75 / 3, 1e-6);
  EXPECT_NEAR(d.max, 1, 1e-6);
  plate.origin.z() = 1e6 - 1;
  cloud.origin.z() = 1e6;
  EXPECT_NEAR(surface_distance(cloud, plate, 1).mean, (1.25 + 0.5 + 2) / 3, 1e-6);
  Mesh one;
  one.positions = {{0, 0, 2}};
  EXPECT_GE(surface_distance(sample_shape("plate"), one, 1, 1000).mean, 2);
}

/// A U of one polygon, which no fan from its first corner covers, and of three squares.
TEST(SurfaceDistance, OfConcavePolygons) {
  Mesh whole, parts;
  whole.positions = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0},
                     {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  whole.faces.push_back({0, 1, 2, 3, 4, 5, 6, 7});
  parts.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {1, 1, 0},
                     {2, 1, 0}, {3, 1, 0}, {0, 3, 0}, {1, 3, 0}, {2, 3, 0}, {3, 3, 0}};
  for (const Index at : {0, 1, 2, 4, 6}) parts.faces.push_back({at, at + 1, at + 5, at + 4});
  EXPECT_LT(surface_distance(whole, parts, 1, 2000).max, 1e-6);
  EXPECT_LT(surface_distance(parts, whole, 1, 2000).max, 1e-6);
}

TEST(SurfaceDistance, IsTheSameForAnyNumberOfThreads) {
  const Mesh a = sample_shape("blob"), b = sample_shape("sphere");
  const auto one = surface_distance(a, b, 1, 4000, Context(1));
  const auto three = surface_distance(a, b, 1, 4000, Context(3));
  EXPECT_EQ(one.mean, three.mean);
  EXPECT_EQ(one.max, three.max);
}

TEST(SurfaceDistance, RefusesEmptyMeshesAndLengths) {
  const Mesh plate = sample_shape("plate");
  EXPECT_THROW(surface_distance(plate, Mesh(), 1), Error);
  EXPECT_THROW(surface_distance(Mesh(), plate, 1), Error);
  EXPECT_THROW(surface_distance(plate, plate, 0), Error);
  EXPECT_THROW(surface_distance(plate, plate, std::nan("")), Error);
}

/// Seven hexagons: the inner vertices have three neighbours.
TEST(MeshStatistics, AHoneycombIsRegular) {
  Mesh mesh;
  std::map<std::pair<long, long>, Index> found;
  const auto corner = [&](double x, double y) {
    const auto [it, fresh] = found.try_emplace({std::lround(x * 1000), std::lround(y * 1000)},
                                               static_cast<Index>(mesh.positions.size()));
    if (fresh) mesh.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
    return it->second;
  };
  const double step = std::numbers::pi / 3;
  for (int cell = 0; cell < 7; ++cell) {
    const double far = cell == 0 ? 0 : std::sqrt(3.0), turn = (cell + 0.5) * step;
    std::vector<Index> face;
    for (int k = 0; k < 6; ++k) {
      face.push_back(corner(far * std::cos(turn) + std::cos(k * step),
                            far * std::sin(turn) + std::sin(k * step)));
    }
    mesh.faces.push_back(face);
  }
  MeshStatistics s = mesh_statistics(mesh);
  EXPECT_EQ(s.vertices, 24u);
  EXPECT_EQ(s.irregular_vertices, 0u);
  EXPECT_EQ(s.singularities, 0u);
  EXPECT_NEAR(s.angle_sigma, 0, 1e-3);
}

TEST(KeptLines, AreAllOfThemInTheSameMesh) {
  const Mesh cube = sample_shape("cube"), plate = sample_shape("plate");
  const KeptLines of_cube = kept_lines(cube, cube), of_plate = kept_lines(plate, plate);
  EXPECT_EQ(of_cube.creases, 1.0);
  EXPECT_FALSE(of_cube.border);
  EXPECT_EQ(of_cube.corners, 8u);
  EXPECT_EQ(of_cube.corners_kept, 8u);
  EXPECT_EQ(of_plate.border, 1.0);
  EXPECT_FALSE(of_plate.creases);
}

/// A cube whose upper face has sunk by half an edge keeps the lower square, and that alone.
TEST(KeptLines, AreMissedWhereTheyAreFar) {
  const Mesh cube = sample_shape("cube");
  Mesh sunk = cube;
  const auto step = static_cast<float>(edge_lengths(cube).mean / 2);
  for (Vec3& p : sunk.positions) {
    if (p.z() > 0.499f) p.z() -= step;
  }
  const KeptLines kept = kept_lines(cube, sunk);
  EXPECT_NEAR(*kept.creases, 8.0 / 12, 0.02);
  EXPECT_EQ(kept.corners_kept, 4u);
}

}  // namespace
}  // namespace meshgrain
