#include "cloud/thin_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cloud/nearest_neighbors.h"
#include "made_points.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

/// Along the curve.
Mesh cloud_of(const made::Sample& sample) {
  Mesh cloud;
  cloud.positions = sample.points;
  cloud.normals = sample.normals;
  sort_along_curve(cloud);
  return cloud;
}

double mean_distance_to_sphere(const Mesh& cloud) {
  double sum = 0;
  for (const Vec3& p : cloud.positions) sum += std::abs(double{p.norm()} - 1);
  return sum / static_cast<double>(cloud.positions.size());
}

TEST(ThinOut, LeavesEnoughPointsEverywhere) {
  Mesh cloud = cloud_of(made::sphere(200000, 1));
  for (const Vec3& p : cloud.positions) cloud.values.push_back(p.x());
  ASSERT_TRUE(thin_out(cloud, {.points = 5000}, Context(2)));
  EXPECT_GE(cloud.positions.size(), 5000u);
  EXPECT_LE(cloud.positions.size(), 20500u) << "cells half as wide would be four times as many";
  ASSERT_EQ(cloud.normals.size(), cloud.positions.size());
  ASSERT_EQ(cloud.values.size(), cloud.positions.size());
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    EXPECT_NEAR(cloud.positions[i].norm(), 1, 0.001f);
    EXPECT_GT(cloud.normals[i].dot(cloud.positions[i]), 0.998f);
    EXPECT_NEAR(cloud.values[i], cloud.positions[i].x(), 1e-5f);
  }
  const std::vector<Vec3> everywhere = made::sphere(20000, 1).points;
  const std::vector<Index> nearest = nearest_points(cloud.positions, everywhere);
  for (std::size_t i = 0; i < everywhere.size(); ++i) {
    EXPECT_LT((everywhere[i] - cloud.positions[nearest[i]]).norm(), 0.06f);
  }
}

TEST(ThinOut, CellsAreNoWiderThanAsked) {
  Mesh cloud = cloud_of(made::sphere(200000, 1));
  ASSERT_TRUE(thin_out(cloud, {.cell = 0.05}, Context(2)));
  const double cells_of_plane = 4 * 3.1416 / (0.05 * 0.05);
  EXPECT_GT(static_cast<double>(cloud.positions.size()), cells_of_plane);
}

TEST(ThinOut, TakesSomeNoiseAway) {
  made::Sample sphere = made::sphere(200000, 1);
  sphere.shake(0.02f);  // a third of a cell
  Mesh cloud = cloud_of(sphere);
  const double before = mean_distance_to_sphere(cloud);
  ASSERT_TRUE(thin_out(cloud, {.points = 1000}, Context(2)));
  EXPECT_LT(mean_distance_to_sphere(cloud), 0.75 * before);
}

TEST(ThinOut, SidesOfAThinPlateStayApart) {
  constexpr float thickness = 0.02f;
  made::Sample plate = made::plate(200, thickness);
  Mesh cloud = cloud_of(plate);
  ASSERT_TRUE(thin_out(cloud, {.cell = 0.1}, Context(2)));
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const Vec3& p = cloud.positions[i];
    if (p.head<2>().cwiseAbs().maxCoeff() > 0.8f) continue;
    EXPECT_NEAR(p.z(), cloud.normals[i].z() * thickness / 2, 1e-4f);
  }
}

TEST(ThinOut, CloudsOfHardlyMorePointsStay) {
  Mesh cloud = cloud_of(made::sphere(10000, 1));
  EXPECT_FALSE(thin_out(cloud, {.points = 8000}, Context(2)));
  EXPECT_FALSE(thin_out(cloud, {.cell = 0.01}, Context(2)));
  EXPECT_EQ(cloud.positions.size(), 10000u);
  Mesh none;
  EXPECT_FALSE(thin_out(none, {.cell = 1}, Context(2)));
}

TEST(ThinOut, AnyNumberOfThreadsGivesTheSame) {
  Mesh one = cloud_of(made::sphere(100000, 1)), three = one;
  ASSERT_TRUE(thin_out(one, {.points = 3000}, Context(1)));
  ASSERT_TRUE(thin_out(three, {.points = 3000}, Context(3)));
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.normals, three.normals);
}

/// What is made by count and what is made by length.
TEST(ThinOut, FacesAreThoseOfTheWholeCloud) {
  Mesh cloud = cloud_of(made::torus(600, 300, 1, 0.4));
  RemeshOptions by_count, by_length;
  by_count.face_count = 1000;
  by_length.edge_length = 0.125;
  for (const RemeshOptions& options : {by_count, by_length}) {
    const RemeshResult result = remesh(cloud, options);
    EXPECT_LT(result.report.nodes, cloud.positions.size() / 4);
    const MeshStatistics statistics = mesh_statistics(result.mesh);
    EXPECT_NEAR(static_cast<double>(statistics.faces), 1000, 100);
    EXPECT_EQ(statistics.euler, 0);
    EXPECT_EQ(statistics.boundary_loops, 0u);
    EXPECT_LT(statistics.area_sigma, 0.2);
    RemeshOptions all = options;
    all.coarsen = false;
    EXPECT_EQ(remesh(cloud, all).report.nodes, cloud.positions.size());
  }
}

}  // namespace
}  // namespace meshgrain
