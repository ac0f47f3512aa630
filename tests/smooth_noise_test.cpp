#include "cloud/smooth_noise.h"

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

bool smooth_noise_of(Mesh& cloud) {
  Neighborhoods nearest = nearest_neighbors(cloud.positions, k);
  const bool was_noisy = smooth_noise(cloud, nearest, Context(2));
  EXPECT_EQ(nearest.indices, nearest_neighbors(cloud.positions, k).indices);
  return was_noisy;
}

Mesh cloud_of(const std::vector<Vec3>& points) {
  Mesh cloud;
  cloud.positions = points;
  return cloud;
}

double mean_distance_to_sphere(const Mesh& cloud) {
  double sum = 0;
  for (const Vec3& p : cloud.positions) sum += std::abs(double{p.norm()} - 1);
  return sum / static_cast<double>(cloud.positions.size());
}

TEST(SmoothNoise, PointsComeNearTheSurface) {
  for (const std::size_t count : {2000u, 20000u}) {
    made::Sample sphere = made::sphere(count, 1);
    sphere.shake(0.05f);
    Mesh cloud = cloud_of(sphere.points);
    const double before = mean_distance_to_sphere(cloud);
    EXPECT_TRUE(smooth_noise_of(cloud));
    EXPECT_LT(mean_distance_to_sphere(cloud), 0.4 * before) << count;
    Vec3 middle = Vec3::Zero();
    double radius = 0;
    for (const Vec3& p : cloud.positions) {
      middle += p / static_cast<float>(count);
      radius += double{p.norm()} / static_cast<double>(count);
    }
    EXPECT_LT(middle.norm(), 0.01f);
    EXPECT_NEAR(radius, 1, 0.005) << "it does not shrink";
  }
}

TEST(SmoothNoise, EvenSurfacesStayAsTheyAre) {
  for (const made::Sample& sample :
       {made::sphere(2000, 1), made::torus(60, 20, 1, 0.3), made::plate(60, 0.2f)}) {
    Mesh cloud = cloud_of(sample.points);
    EXPECT_FALSE(smooth_noise_of(cloud));
    EXPECT_EQ(cloud.positions, sample.points);
  }
}

TEST(SmoothNoise, SidesOfAThinPlateStayApartIfNormalsTellThem) {
  constexpr float thickness = 0.08f, apart = 2.0f / 59;
  made::Sample plate = made::plate(60, thickness);
  plate.shake(0.6f * apart);
  Mesh cloud = cloud_of(plate.points);
  cloud.normals = plate.normals;
  ASSERT_TRUE(smooth_noise_of(cloud));
  double off = 0, count = 0;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const Vec3& p = cloud.positions[i];
    if (p.head<2>().cwiseAbs().maxCoeff() > 0.8f) continue;
    off += std::abs(double{p.z() * cloud.normals[i].z()} - thickness / 2);
    ++count;
  }
  EXPECT_LT(off / count, 0.1 * thickness);
}

TEST(SmoothNoise, FacesOfANoisyCloudAreAsGoodAsOthers) {
  made::Sample torus = made::torus(200, 100, 1, 0.4);
  torus.shake(0.04f);
  RemeshOptions options;
  options.face_count = 2000;
  const RemeshResult result = remesh(cloud_of(torus.points), options);
  const MeshStatistics statistics = mesh_statistics(result.mesh);
  EXPECT_EQ(statistics.euler, 0);
  EXPECT_EQ(statistics.boundary_loops, 0u);
  EXPECT_EQ(statistics.inverted_quads, 0u);
  EXPECT_LT(statistics.area_sigma, 0.2);
  EXPECT_LT(statistics.angle_sigma, 10);
  EXPECT_TRUE(std::ranges::any_of(result.report.notes, [](const std::string& note) {
    return note.find("noise") != std::string::npos;
  }));
}

/// Their sides are nearer to each other than the points.
TEST(SmoothNoise, PlatesThinnerThanPointsAreApartKeepTheirSides) {
  constexpr float apart = 2.0f / 59;
  const made::Sample plate = made::plate(60, apart);
  Mesh cloud = cloud_of(plate.points);
  cloud.normals = plate.normals;
  RemeshOptions options;
  options.face_count = 800;
  const MeshStatistics statistics = mesh_statistics(remesh(cloud, options).mesh);
  EXPECT_EQ(statistics.euler, 2);
  EXPECT_EQ(statistics.boundary_loops, 0u);
  EXPECT_EQ(statistics.components, 1u);
}

}  // namespace
}  // namespace meshgrain
