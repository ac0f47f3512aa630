#include "sharpen/narrow_bends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "has_note.h"
#include "kept_creases.h"
#include "made_box.h"
#include "measure/bvh.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "same_topology.h"
#include "sharpen/round_again.h"

namespace meshgrain {
namespace {

const Vec3 half(1, 0.5f, 0.2f);
constexpr const char* note = "made sharp edges";

double distance(const Bvh& tree, const Vec3& p) {
  return std::sqrt(tree.closest(p.cast<double>()).squared_distance);
}

double largest_distance(const Mesh& from, const Mesh& to) {
  const Bvh tree(to);
  double most = 0;
  for (const Vec3& p : from.positions) most = std::max(most, distance(tree, p));
  return most;
}

/// A polygon, counter-clockwise, as high as it says.
Mesh prism(const std::vector<Eigen::Vector2f>& profile, float height) {
  Mesh mesh;
  std::vector<Index> top, bottom;
  for (const Eigen::Vector2f& p : profile) {
    bottom.push_back(static_cast<Index>(mesh.positions.size()));
    mesh.positions.emplace_back(p.x(), p.y(), 0);
    top.push_back(static_cast<Index>(mesh.positions.size()));
    mesh.positions.emplace_back(p.x(), p.y(), height);
  }
  for (std::size_t i = 0; i < top.size(); ++i) {
    const std::size_t next = (i + 1) % top.size();
    mesh.faces.push_back({top[i], bottom[i], bottom[next], top[next]});
  }
  mesh.faces.push_back(top);
  std::ranges::reverse(bottom);
  mesh.faces.push_back(bottom);
  return triangulate(mesh);
}

/// From one angle to another, in quarters of a turn.
void add_arc(std::vector<Eigen::Vector2f>& profile, const Eigen::Vector2f& center, float radius,
             int from, int to, int segments = 6) {
  for (int i = 0; i <= segments; ++i) {
    const double turn = from + (to - from) * static_cast<double>(i) / segments;
    const auto angle = static_cast<float>(std::numbers::pi / 2 * turn);
    profile.push_back(center + radius * Eigen::Vector2f(std::cos(angle), std::sin(angle)));
  }
}

/// A plate whose upright edges are rounded, and no others.
Mesh rounded_plate(float radius) {
  const float x = 1 - radius, y = 0.7f - radius;
  std::vector<Eigen::Vector2f> profile;
  add_arc(profile, {x, y}, radius, 0, 1);
  add_arc(profile, {-x, y}, radius, 1, 2);
  add_arc(profile, {-x, -y}, radius, 2, 3);
  add_arc(profile, {x, -y}, radius, 3, 4);
  return prism(profile, 0.4f);
}

/// A sheet bent to an L.
Mesh bent_sheet(float thickness, float inner_radius) {
  const float outer = inner_radius + thickness;
  std::vector<Eigen::Vector2f> profile{{1, 0}, {1, thickness}};
  add_arc(profile, {outer, outer}, inner_radius, 3, 2);
  profile.insert(profile.end(), {{thickness, 1}, {0, 1}});
  add_arc(profile, {outer, outer}, outer, 2, 3);
  return prism(profile, 0.8f);
}

RemeshResult remeshed(const Mesh& mesh, std::size_t faces) {
  RemeshOptions options;
  options.face_count = faces;
  return remesh(mesh, options);
}

TEST(NarrowBends, NarrowChamfersAndRoundingsGo) {
  for (const Index segments : {1u, 3u, 8u}) {
    SCOPED_TRACE(segments);
    Mesh mesh = made::rounded_box(half, 0.02f, segments);
    const Mesh before = mesh;
    const Mesh bent = sharpen_bends(mesh, {.chamfer = 0.03, .rounding = 0.03}, Context(2));
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.faces.size(), 12u);
    EXPECT_EQ(bent.faces.size(), before.faces.size() - 12);
    for (const Vec3& p : mesh.positions) {
      EXPECT_LT((p.cwiseAbs() - half).norm(), 1e-4f);
    }
    made::expect_same_topology(mesh_statistics(mesh), mesh_statistics(before));
  }
}

TEST(NarrowBends, WiderOnesStay) {
  for (const Index segments : {1u, 3u, 8u}) {
    SCOPED_TRACE(segments);
    Mesh mesh = made::rounded_box(half, 0.02f, segments);
    const std::size_t faces = mesh.faces.size();
    EXPECT_TRUE(sharpen_bends(mesh, {.chamfer = 0.02, .rounding = 0.02}, Context(2)).faces.empty());
    EXPECT_EQ(mesh.faces.size(), faces);
  }
}

TEST(NarrowBends, ChamfersStayWhereRoundingsAsWideGo) {
  Mesh chamfered = made::rounded_box(half, 0.02f, 1), round = made::rounded_box(half, 0.02f, 3);
  const BendWidths widths{.chamfer = 0.02, .rounding = 0.05};
  EXPECT_TRUE(sharpen_bends(chamfered, widths, Context(2)).faces.empty());
  EXPECT_FALSE(sharpen_bends(round, widths, Context(2)).faces.empty());
}

TEST(NarrowBends, WideChamfersOfTwoStripsStay) {
  Mesh mesh = made::rounded_box({1, 0.5f, 0.2f}, 0.05f, 2);
  EXPECT_TRUE(sharpen_bends(mesh, {.chamfer = 0.045, .rounding = 0.15}, Context(2)).faces.empty());
}

TEST(NarrowBends, ThinPlatesAreNotFlattened) {
  Mesh plate = made::rounded_box({1, 0.5f, 0.01f}, 0.002f, 3);
  sharpen_bends(plate, {.chamfer = 0.05, .rounding = 0.05}, Context(2));
  EXPECT_EQ(plate.positions.size(), 8u);
  for (const Vec3& p : plate.positions) EXPECT_NEAR(std::abs(p.z()), 0.01f, 1e-5f);
  made::expect_same_topology(mesh_statistics(plate),
                             mesh_statistics(made::rounded_box(half, 1, 1)));
}

TEST(NarrowBends, SculpturesStayAsTheyAre) {
  for (const char* name : {"sphere", "torus", "three-holes", "blob"}) {
    SCOPED_TRACE(name);
    Mesh mesh = sample_shape(name, 0.3);
    const std::size_t faces = mesh.faces.size();
    EXPECT_TRUE(sharpen_bends(mesh, {.chamfer = 0.3, .rounding = 0.5}, Context(2)).faces.empty());
    EXPECT_EQ(mesh.faces.size(), faces);
  }
}

// Before, they had 42 irregular vertices, and a face without area at 500 faces.
TEST(NarrowBends, BoxesWithNarrowChamfersBecomeBoxes) {
  const Mesh input = made::rounded_box(half, 0.004f, 1);
  for (const std::size_t faces : {500u, 2000u}) {
    SCOPED_TRACE(faces);
    const RemeshResult result = remeshed(input, faces);
    EXPECT_TRUE(made::has_note(result, note));
    const MeshStatistics found = mesh_statistics(result.mesh);
    made::expect_same_topology(found, mesh_statistics(input));
    EXPECT_LE(found.singularities, 20u);
    EXPECT_GT(least_jacobian(result.mesh), 0.6f);
    EXPECT_TRUE(find_crossings(result.mesh, Context(2)).empty());
    EXPECT_LT(largest_distance(input, result.mesh), 0.004);
  }
  RemeshOptions options;
  options.face_count = 500;
  options.features.creases = Creases::none;
  EXPECT_FALSE(made::has_note(remesh(input, options), note));
}

// Where they do not, faces cut off more of the edges: of these 5 and 2.2 times as much.
TEST(NarrowBends, RowsRunAlongRoundingsAsWideAsFaces) {
  for (const float radius : {0.05f, 0.1f}) {
    SCOPED_TRACE(radius);
    const Mesh input = made::rounded_box({1, 0.8f, 0.6f}, radius, 6);
    const RemeshResult result = remeshed(input, 1000);
    EXPECT_FALSE(made::has_note(result, note));  // they are not lost
    made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(input));
    EXPECT_GT(least_jacobian(result.mesh), 0.4f);
    EXPECT_LT(largest_distance(result.mesh, input), 0.1 * radius);
    RemeshOptions without;
    without.face_count = 1000;
    without.features.creases = Creases::none;
    const double as_before = largest_distance(input, remesh(input, without).mesh);
    EXPECT_LT(2 * largest_distance(input, result.mesh), as_before);
  }
}

TEST(NarrowBends, RoundingsMayEndAtSharpEdges) {
  const float radius = 0.07f;
  const Mesh input = rounded_plate(radius);
  const RemeshResult result = remeshed(input, 1500);
  made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(input));
  EXPECT_GT(least_jacobian(result.mesh), 0.4f);
  EXPECT_LT(largest_distance(result.mesh, input), 0.1 * radius);
  EXPECT_GT(made::kept_creases(input, result.mesh).creases, 0.9);
}

TEST(NarrowBends, BothSidesOfABentSheetAreRoundedAgain) {
  for (const float radius : {0.03f, 0.06f}) {
    SCOPED_TRACE(radius);
    const Mesh input = bent_sheet(0.04f, radius);
    const RemeshResult result = remeshed(input, 2000);
    made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(input));
    EXPECT_TRUE(find_crossings(result.mesh, Context(2)).empty());
    EXPECT_GT(least_jacobian(result.mesh), 0.2f);
    EXPECT_LT(largest_distance(result.mesh, input), 0.3 * radius);
  }
}

TEST(NarrowBends, OnlyWhatIsOverARoundingGoesBackToIt) {
  const Mesh input = made::rounded_box(half, 0.1f, 6);
  Mesh sharp = input;
  const Mesh roundings = sharpen_bends(sharp, {.chamfer = 0, .rounding = 0.15}, Context(2));
  const RemeshResult result = remeshed(sharp, 2000);
  Mesh round = result.mesh;
  round_again(round, roundings, Context(2));
  const Bvh tree(input);
  ASSERT_EQ(round.positions.size(), result.mesh.positions.size());
  std::size_t over = 0;
  for (std::size_t v = 0; v < round.positions.size(); ++v) {
    const Vec3& before = result.mesh.positions[v];
    const Vec3 inside = half - Vec3::Constant(0.1f) - before.cwiseAbs();
    const auto beyond = std::ranges::count_if(inside, [](float x) { return x < 0; });
    if (beyond < 2) {
      EXPECT_LT((round.positions[v] - before).norm(), 1e-5f);
    } else {
      EXPECT_LT(distance(tree, round.positions[v]), 1e-5);
      ++over;
    }
  }
  EXPECT_GT(over, 400u);
}

}  // namespace
}  // namespace meshgrain
