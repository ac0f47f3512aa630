#include "cloud/fill_in.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "made_points.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"

namespace meshgrain {
namespace {

constexpr std::size_t k = 10;

Mesh cloud_of(const made::Sample& sample) {
  Mesh cloud;
  cloud.positions = sample.points;
  cloud.normals = sample.normals;
  return cloud;
}

/// In no order, and as dense here as there: gaps are three times as wide as points are apart.
made::Sample scattered_on_sphere(std::size_t count) {
  made::Sample sample;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double z = made::noise(2 * i), angle = 3.14159265 * made::noise(2 * i + 1);
    const double r = std::sqrt(1 - z * z);
    const Vec3 n = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
    sample.add(n, n);
  }
  return sample;
}

std::size_t fill(Mesh& cloud, float apart) {
  Neighborhoods nearest = nearest_neighbors(cloud.positions, k);
  const std::size_t added = fill_in(cloud, nearest, apart, Context(2));
  EXPECT_EQ(nearest.indices, nearest_neighbors(cloud.positions, k).indices);
  EXPECT_EQ(cloud.normals.size(), cloud.positions.size());
  return added;
}

TEST(FillIn, LeavesNoGapsAndStaysOnTheSurface) {
  Mesh cloud = cloud_of(scattered_on_sphere(800));
  const std::vector<Vec3> before = cloud.positions;
  constexpr float apart = 0.08f;
  EXPECT_GT(fill(cloud, apart), before.size());
  EXPECT_TRUE(std::equal(before.begin(), before.end(), cloud.positions.begin()));
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    EXPECT_NEAR(cloud.positions[i].norm(), 1, 0.01f);
    EXPECT_GT(cloud.normals[i].dot(cloud.positions[i].normalized()), 0.98f);
  }
  const std::vector<Vec3> everywhere = made::sphere(20000, 1).points;
  const std::vector<Index> nearest = nearest_points(cloud.positions, everywhere);
  std::size_t bare = 0;
  for (std::size_t i = 0; i < everywhere.size(); ++i) {
    bare += (everywhere[i] - cloud.positions[nearest[i]]).norm() > 1.25f * apart;
  }
  EXPECT_LT(bare, everywhere.size() / 50) << "but for the widest gaps";
  // And not many more than it takes.
  EXPECT_LT(static_cast<float>(cloud.positions.size()) * apart * apart, 4 * 4 * 3.1416f);
}

TEST(FillIn, DenseCloudsStayAsTheyAre) {
  Mesh cloud = cloud_of(made::sphere(20000, 1));
  EXPECT_EQ(fill(cloud, 0.1f), 0u);
}

TEST(FillIn, ValuesAreThoseBetween) {
  Mesh cloud = cloud_of(made::sphere(500, 1));
  for (const Vec3& p : cloud.positions) cloud.values.push_back(p.z());
  fill(cloud, 0.1f);
  ASSERT_EQ(cloud.values.size(), cloud.positions.size());
  for (std::size_t i = 0; i < cloud.values.size(); ++i) {
    EXPECT_NEAR(cloud.values[i], cloud.positions[i].z(), 0.05f);
  }
}

TEST(FillIn, NoPointsBetweenTheSidesOfAThinPlate) {
  constexpr float thickness = 0.1f;
  Mesh cloud = cloud_of(made::plate(15, thickness));  // 0.14 apart
  EXPECT_GT(fill(cloud, 0.1f), 0u);
  for (const Vec3& p : cloud.positions) {
    if (p.head<2>().cwiseAbs().maxCoeff() < 0.9f) {
      EXPECT_GT(std::abs(p.z()), 0.4f * thickness);
    }
  }
}

/// Whatever the number of faces is beside that of the points.
TEST(FillIn, FewPointsMakeManyFaces) {
  Mesh cloud = cloud_of(made::torus(40, 20, 1, 0.4));
  cloud.normals.clear();
  RemeshOptions options;
  options.face_count = 4000;
  const RemeshResult result = remesh(cloud, options);
  EXPECT_NEAR(static_cast<double>(result.mesh.faces.size()), 4000, 40);
  const MeshStatistics statistics = mesh_statistics(result.mesh);
  EXPECT_EQ(statistics.euler, 0);
  EXPECT_EQ(statistics.boundary_loops, 0u);
  EXPECT_LT(statistics.area_sigma, 0.2);
}

}  // namespace
}  // namespace meshgrain
