#include "field/bend_alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "made_fields.h"
#include "meshgrain/graph.h"
#include "meshgrain/shapes.h"

namespace meshgrain {
namespace {

constexpr float half_width = 0.3f, half_height = 0.04f;

/// A flat ring about z with rounded rims, its middle of radius 1.
Mesh flat_ring() {
  return made::grid(400, 64, true, true, [](double u, double v) -> Vec3 {
    const double a = 2 * std::numbers::pi * u, b = 2 * std::numbers::pi * v;
    const double r = 1 + half_width * std::cos(b), z = half_height * std::sin(b);
    return Eigen::Vector3d(r * std::cos(a), r * std::sin(a), z).cast<float>();
  });
}

std::vector<OrientationConstraint> constraints_on(const Mesh& mesh, float edge_length,
                                                  float strength = 1,
                                                  const FeatureLines& creases = {},
                                                  int threads = 2) {
  const Hierarchy hierarchy = build_hierarchy(build_graph(mesh));
  return bend_constraints(hierarchy, mesh, vertex_faces(mesh), creases, edge_length, strength,
                          Context(threads));
}

bool is_at_rim(const Vec3& p) {
  return std::abs(std::hypot(p.x(), p.y()) - 1) > 0.9f * half_width;
}

/// The angle to the direction around the ring, in degrees.
double degrees_off(const Vec3& p, const Vec3& direction) {
  const Vec3 around = Vec3(-p.y(), p.x(), 0).normalized();
  return std::acos(std::min(1.0f, std::abs(around.dot(direction)))) * 180 / std::numbers::pi;
}

TEST(BendAlignment, PullsAlongTheRimsOfAFlatRing) {
  const Mesh ring = flat_ring();
  const auto constraints = constraints_on(ring, 0.12f);
  std::vector<std::uint8_t> pulled(ring.positions.size(), 0);
  for (const OrientationConstraint& c : constraints) {
    EXPECT_FALSE(pulled[c.node]++);
    EXPECT_GT(c.strength, 0);
    EXPECT_LE(c.strength, 1);
    EXPECT_LT(degrees_off(ring.positions[c.node], c.direction), 20);
  }
  for (std::size_t i = 0; i < pulled.size(); ++i) {
    EXPECT_TRUE(pulled[i] || !is_at_rim(ring.positions[i]));
  }
}

TEST(BendAlignment, TurnsTheFieldAlongTheRims) {
  const Mesh ring = flat_ring();
  const Hierarchy hierarchy = build_hierarchy(build_graph(ring));
  const auto mean_degrees = [&](float strength) {
    const auto constraints =
        bend_constraints(hierarchy, ring, vertex_faces(ring), {}, 0.12f, strength, Context());
    double sum = 0;
    std::size_t count = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      OrientationOptions options;
      options.seed = seed;
      const auto field = solve_orientation(hierarchy, options, constraints);
      for (std::size_t i = 0; i < ring.positions.size(); ++i) {
        if (!is_at_rim(ring.positions[i])) continue;
        const double angle = degrees_off(ring.positions[i], field.directions[i]);
        sum += std::min(angle, 90 - angle);
        ++count;
      }
    }
    return sum / static_cast<double>(count);
  };
  EXPECT_GT(mean_degrees(0), 5);
  EXPECT_LT(mean_degrees(0.5f), 3);
}

TEST(BendAlignment, LeavesRoundAndGentleShapesAlone) {
  EXPECT_TRUE(constraints_on(sample_shape("sphere"), 0.3f).empty());
  EXPECT_TRUE(constraints_on(sample_shape("torus"), 0.05f).empty());
  EXPECT_TRUE(constraints_on(sample_shape("plate"), 0.1f).empty());
  EXPECT_TRUE(constraints_on(flat_ring(), 0.12f, 0).empty());
}

TEST(BendAlignment, LeavesGraphsOfFacesAlone) {
  const Mesh ring = flat_ring();
  GraphOptions faces;
  faces.nodes = GraphNodes::faces;
  const Hierarchy hierarchy = build_hierarchy(build_graph(ring, faces));
  EXPECT_TRUE(
      bend_constraints(hierarchy, ring, vertex_faces(ring), {}, 0.12f, 1, Context()).empty());
}

TEST(BendAlignment, LeavesCreasesToTheirConstraints) {
  const Mesh cube = sample_shape("cube");
  FeatureOptions options;
  options.creases = Creases::by_angle;
  const FeatureLines creases = find_features(cube, options, 0.1);
  EXPECT_FALSE(constraints_on(cube, 0.1f).empty());
  EXPECT_TRUE(constraints_on(cube, 0.1f, 1, creases).empty());
}

TEST(BendAlignment, IsTheSameForAnyNumberOfThreads) {
  const Mesh ring = flat_ring();
  const auto one = constraints_on(ring, 0.1f, 1, {}, 1),
             three = constraints_on(ring, 0.1f, 1, {}, 3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].node, three[k].node);
    EXPECT_EQ(one[k].direction, three[k].direction);
    EXPECT_EQ(one[k].strength, three[k].strength);
  }
}

}  // namespace
}  // namespace meshgrain
