#include "cloud/outliers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "made_points.h"
#include "meshgrain/remesh.h"

namespace meshgrain {
namespace {

constexpr std::size_t k = 10;

/// Evenly in a cube around the origin.
std::vector<Vec3> scattered(std::size_t count, float half_side) {
  std::vector<Vec3> points;
  for (std::uint64_t i = 0; i < count; ++i) {
    points.push_back(half_side *
                     Vec3(made::noise(3 * i), made::noise(3 * i + 1), made::noise(3 * i + 2)));
  }
  return points;
}

/// A sphere of radius 1 with points around it.
std::vector<Vec3> sphere_among(const std::vector<Vec3>& others) {
  std::vector<Vec3> points = made::sphere(10000, 1).points;
  points.insert(points.end(), others.begin(), others.end());
  return points;
}

std::vector<Index> outliers_of(const std::vector<Vec3>& points) {
  return find_outliers(points, nearest_neighbors(points, k), Context(2));
}

float distance_to_sphere(const Vec3& p) {
  return std::abs(p.norm() - 1);
}

TEST(Outliers, ThereAreNoneOnEvenSurfaces) {
  for (const float shake : {0.0f, 0.02f}) {
    made::Sample sphere = made::sphere(10000, 1);
    sphere.shake(shake);
    EXPECT_TRUE(outliers_of(sphere.points).empty());
  }
  EXPECT_TRUE(outliers_of(made::plate(60, 0.1f).points).empty());
  EXPECT_TRUE(outliers_of({}).empty());
  EXPECT_TRUE(outliers_of({Vec3(0, 0, 0), Vec3(1, 0, 0)}).empty());
}

TEST(Outliers, SurfacesWithFewPointsAreNone) {
  // A dense sphere over a floor whose points are twenty times as far apart.
  std::vector<Vec3> points = made::sphere(10000, 1, Vec3(0, 0, 4)).points;
  const std::size_t dense = points.size();
  constexpr float apart = 0.7f;
  for (int i = -12; i <= 12; ++i)
    for (int j = -12; j <= 12; ++j)
      points.emplace_back(apart * static_cast<float>(i), apart * static_cast<float>(j), 0);
  const std::vector<Index> found = outliers_of(points);
  EXPECT_TRUE(found.empty()) << found.size() << " of " << points.size() - dense;
}

TEST(Outliers, PointsFarFromASurfaceAreFound) {
  for (const float half_side : {1.5f, 10.0f, 1000.0f}) {
    for (const std::size_t count : {1u, 20u, 500u}) {
      Mesh cloud;
      cloud.positions = sphere_among(scattered(count, half_side));
      cloud.values.resize(cloud.positions.size(), 0);
      std::fill(cloud.values.begin() + 10000, cloud.values.end(), 1.0f);
      Neighborhoods nearest = nearest_neighbors(cloud.positions, k);
      const std::size_t dropped = drop_outliers(cloud, nearest, Context(2));
      EXPECT_EQ(dropped + cloud.positions.size(), 10000 + count);
      EXPECT_EQ(std::ranges::count(cloud.values, 0.0f), 10000) << "points of the sphere are left";
      float farthest = 0;
      for (const Vec3& p : cloud.positions) farthest = std::max(farthest, distance_to_sphere(p));
      EXPECT_LT(farthest, 0.4f) << count << " in a cube of half side " << half_side;
      EXPECT_EQ(nearest.indices, nearest_neighbors(cloud.positions, k).indices);
    }
  }
}

TEST(Outliers, ACloudOfNothingElseStays) {
  Mesh cloud;
  cloud.positions = scattered(300, 1);
  Neighborhoods nearest = nearest_neighbors(cloud.positions, k);
  EXPECT_EQ(drop_outliers(cloud, nearest, Context(2)), 0u);
}

/// They would take all the faces: each is as large as what is around it.
TEST(Outliers, FacesCoverTheSurfaceAlone) {
  Mesh cloud;
  cloud.positions = sphere_among(scattered(40, 20));
  RemeshOptions options;
  options.face_count = 1000;
  const RemeshResult result = remesh(cloud, options);
  EXPECT_NEAR(static_cast<double>(result.mesh.faces.size()), 1000, 20);
  for (const Vec3& p : result.mesh.positions) EXPECT_LT(distance_to_sphere(p), 0.02f);
  EXPECT_TRUE(std::ranges::any_of(result.report.notes, [](const std::string& note) {
    return note == "left out 40 points far from all others";
  }));
}

}  // namespace
}  // namespace meshgrain
