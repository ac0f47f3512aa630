#include "meshgrain/normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "made_points.h"

namespace meshgrain {
namespace {

Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  for (const auto& f : {std::array<Index, 4>{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}})
    mesh.faces.push_back(f);
  return mesh;
}

void expect_unit(const std::vector<Vec3>& normals) {
  for (const Vec3& n : normals) EXPECT_NEAR(n.norm(), 1, 1e-5);
}

TEST(VertexNormals, CubeCornersPointAlongTheDiagonals) {
  const Mesh mesh = cube();
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < 8; ++v) {
    const Vec3 out = (mesh.positions[v] - Vec3::Constant(0.5f)).normalized();
    EXPECT_GT(normals[v].dot(out), 0.99999f);
  }
}

TEST(VertexNormals, DoNotDependOnTheTriangulation) {
  Mesh mesh = cube(), triangles = cube();
  triangles.faces.clear();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto q = mesh.faces[f];
    const std::size_t s = f % 2;
    triangles.faces.push_back({q[s], q[s + 1], q[s + 2]});
    triangles.faces.push_back({q[s], q[s + 2], q[(s + 3) % 4]});
  }
  const auto a = vertex_normals(mesh), b = vertex_normals(triangles);
  for (std::size_t v = 0; v < 8; ++v) EXPECT_GT(a[v].dot(b[v]), 0.99999f);
}

TEST(VertexNormals, CreaseVerticesTakeAFacesNormal) {
  const Mesh mesh = cube();
  for (const Vec3& n : vertex_normals(mesh, 45)) EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1, 1e-6);
  for (const Vec3& n : vertex_normals(mesh, 95)) EXPECT_LT(n.cwiseAbs().maxCoeff(), 0.6f);
}

TEST(VertexNormals, OppositelyOrientedFacesMakeNoCrease) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.2f, 1, 0}, {0.3f, -1, 0.2f}};
  mesh.faces.push_back({0, 1, 2});
  mesh.faces.push_back({0, 1, 3});
  const std::vector<Vec3> normals = vertex_normals(mesh, 30);
  expect_unit(normals);
  EXPECT_NEAR(std::abs(normals[2].z()), 1, 1e-5);
}

TEST(VertexNormals, DegenerateFacesAreSilent) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 0.7f, 0}, {5, 5, 5}, {5, 5, 5}};
  mesh.faces.push_back({0, 1, 2});
  mesh.faces.push_back({1, 3, 2});  // on the edge
  mesh.faces.push_back({4, 5, 3});  // two vertices in one place
  mesh.positions.emplace_back(9, 9, 9);
  const std::vector<Vec3> normals = vertex_normals(mesh, 20);
  expect_unit(normals);
  for (const Vec3& n : normals) EXPECT_NEAR(n.z(), 1, 1e-5);
}

TEST(VertexNormals, BackToBackFacesStillHaveNormals) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces.push_back({0, 1, 2});
  mesh.faces.push_back({0, 2, 1});
  for (const Vec3& n : vertex_normals(mesh)) EXPECT_NEAR(std::abs(n.z()), 1, 1e-5);
}

struct Agreement {
  double share;   // of normals on the right side
  double median;  // angle to the right line, in degrees
};

Agreement agreement(const made::Sample& sample, std::size_t k = 16) {
  Mesh cloud;
  cloud.positions = sample.points;
  const std::vector<Vec3> normals = estimate_normals(cloud, k, Context(2));
  EXPECT_EQ(normals, estimate_normals(cloud, k, Context(1)));
  std::size_t right = 0;
  std::vector<double> angles;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(normals[i].norm(), 1, 1e-5);
    const double dot = normals[i].dot(sample.normals[i]);
    right += dot > 0;
    angles.push_back(std::acos(std::min(1.0, std::abs(dot))) * 180 / std::numbers::pi);
  }
  std::nth_element(angles.begin(), angles.begin() + static_cast<long>(angles.size() / 2),
                   angles.end());
  return {static_cast<double>(right) / static_cast<double>(normals.size()),
          angles[angles.size() / 2]};
}

TEST(EstimateNormals, Sphere) {
  const Agreement found = agreement(made::sphere(3000, 5, {100, 0, 0}));
  EXPECT_EQ(found.share, 1);
  EXPECT_LT(found.median, 1);
}

TEST(EstimateNormals, Torus) {
  const Agreement found = agreement(made::torus(120, 40, 3, 1));
  EXPECT_EQ(found.share, 1);
  EXPECT_LT(found.median, 1);
}

TEST(EstimateNormals, NoisySphere) {
  made::Sample sample = made::sphere(3000, 1);  // neighbours are about 0.065 apart
  sample.shake(0.02f);
  const Agreement found = agreement(sample);
  EXPECT_GT(found.share, 0.998);
  EXPECT_LT(found.median, 10);
}

TEST(EstimateNormals, ThinPlate) {
  // The sides are 2.5 point spacings apart.
  const Agreement found = agreement(made::plate(41, 0.125f));
  EXPECT_GT(found.share, 0.99);
  EXPECT_LT(found.median, 3);
}

TEST(EstimateNormals, EachPartPointsOutwards) {
  made::Sample sample = made::sphere(800, 1);
  const made::Sample other = made::sphere(900, 2, {10, 3, 0});
  for (std::size_t i = 0; i < other.points.size(); ++i)
    sample.add(other.points[i], other.normals[i]);
  EXPECT_EQ(agreement(sample).share, 1);
}

TEST(EstimateNormals, AnyCloudHasUnitNormals) {
  Mesh cloud;
  EXPECT_TRUE(estimate_normals(cloud).empty());
  cloud.positions = {{1, 1, 1}};
  expect_unit(estimate_normals(cloud));
  cloud.positions.assign(50, {1, 1, 1});
  expect_unit(estimate_normals(cloud));
  for (int i = 0; i < 30; ++i) cloud.positions.emplace_back(i, 0, 0);
  expect_unit(estimate_normals(cloud));
}

}  // namespace
}  // namespace meshgrain
