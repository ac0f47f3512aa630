#include "meshgrain/curvature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "cloud/nearest_neighbors.h"
#include "made_points.h"

namespace meshgrain {
namespace {

Curvature of(const made::Sample& sample, int smoothing = 0, const Context& context = Context()) {
  const Neighborhoods near = nearest_neighbors(sample.points, 8);
  std::vector<Index> offsets{0}, neighbors;
  for (std::size_t i = 0; i < sample.points.size(); ++i) {
    neighbors.insert(neighbors.end(), near[i].begin(), near[i].end());
    offsets.push_back(static_cast<Index>(neighbors.size()));
  }
  return estimate_curvature(offsets, neighbors, sample.points, sample.normals, context, smoothing);
}

TEST(Curvature, Sphere) {
  made::Sample sample = made::sphere(2000, 4);
  for (const int smoothing : {0, 3}) {
    const Curvature found = of(sample, smoothing);
    for (std::size_t i = 0; i < sample.points.size(); ++i) {
      EXPECT_NEAR(found.kmax[i], 0.25, 1e-3);
      EXPECT_NEAR(found.kmin[i], 0.25, 1e-3);
      EXPECT_NEAR(found.direction[i].norm(), 1, 1e-5);
      EXPECT_NEAR(found.direction[i].dot(sample.normals[i]), 0, 1e-5);
    }
  }
  for (Vec3& n : sample.normals) n = -n;
  EXPECT_NEAR(of(sample).kmax[5], -0.25, 1e-3);
}

TEST(Curvature, CylinderBendsAroundItsAxis) {
  made::Sample sample;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 30; ++j) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / 60;
      const Vec3 n(std::cos(angle), std::sin(angle), 0);
      sample.add(2 * n + 0.2f * static_cast<float>(j) * Vec3::UnitZ(), n);
    }
  for (const int smoothing : {0, 2}) {
    const Curvature found = of(sample, smoothing);
    for (std::size_t i = 0; i < sample.points.size(); ++i) {
      EXPECT_NEAR(found.kmax[i], 0.5, 2e-3);
      EXPECT_NEAR(found.kmin[i], 0, 2e-3);
      EXPECT_NEAR(found.direction[i].z(), 0, 1e-2);
    }
  }
}

TEST(Curvature, Torus) {
  const double major = 3, minor = 1;
  const made::Sample sample = made::torus(150, 50, major, minor);
  const Curvature found = of(sample);
  for (std::size_t i = 0; i < sample.points.size(); ++i) {
    const Vec3& n = sample.normals[i];
    const double cosine = std::hypot(sample.points[i].x(), sample.points[i].y()) - major;
    EXPECT_NEAR(found.kmax[i], 1 / minor, 0.02);
    EXPECT_NEAR(found.kmin[i], cosine / (major + minor * cosine), 0.02);
    // Across the tube's rings: no part of the direction runs around the axis.
    const Vec3 around = Vec3::UnitZ().cross(sample.points[i]).normalized();
    EXPECT_NEAR(found.direction[i].dot(around), 0, 0.05);
    EXPECT_NEAR(found.direction[i].dot(n), 0, 1e-5);
  }
}

TEST(Curvature, IsTheSameForAnyNumberOfThreads) {
  made::Sample sample = made::torus(150, 50, 3, 1);
  sample.shake(0.01f);
  const Curvature one = of(sample, 2, Context(1)), many = of(sample, 2, Context(4));
  EXPECT_EQ(one.kmax, many.kmax);
  EXPECT_EQ(one.kmin, many.kmin);
  EXPECT_EQ(one.direction, many.direction);
}

TEST(Curvature, NodesWithoutNeighborsAreFlat) {
  const std::vector<Index> offsets{0, 0}, neighbors;
  const std::vector<Vec3> position{{1, 2, 3}}, normal{{0, 0, -1}};
  const Curvature found = estimate_curvature(offsets, neighbors, position, normal);
  EXPECT_EQ(found.kmax[0], 0);
  EXPECT_NEAR(found.direction[0].norm(), 1, 1e-6);
  EXPECT_NEAR(found.direction[0].z(), 0, 1e-6);
}

}  // namespace
}  // namespace meshgrain
