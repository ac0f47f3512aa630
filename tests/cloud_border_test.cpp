#include "cloud/cloud_border.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "made_points.h"
#include "mesh/border.h"
#include "meshgrain/remesh.h"

namespace meshgrain {
namespace {

/// A square of side 2 around the origin with a round hole, of scattered points.
Mesh scattered_square(std::size_t count, float hole) {
  Mesh cloud;
  for (std::uint64_t i = 0; cloud.positions.size() < count; ++i) {
    const Vec3 p(made::noise(2 * i), made::noise(2 * i + 1), 0);
    if (p.norm() < hole) continue;
    cloud.positions.push_back(p);
    cloud.normals.push_back(Vec3::UnitZ());
  }
  return cloud;
}

float distance_to_border(const Vec3& p, float hole) {
  return std::min(1 - p.cwiseAbs().maxCoeff(), p.norm() - hole);
}

TEST(CloudBorder, IsFoundWithItsDirection) {
  constexpr float hole = 0.4f, apart = 0.02f;
  const Graph graph = build_graph(scattered_square(10000, hole));
  const std::vector<BorderNode> border = cloud_border(graph, 0.2f, Context(2));
  std::size_t straight = 0, askew = 0;
  for (const auto& [node, point, direction] : border) {
    const Vec3& p = graph.positions[node];
    EXPECT_LT(distance_to_border(p, hole), 3 * apart);
    if (direction.isZero() || p.cwiseAbs().minCoeff() > 0.85f) continue;  // corners
    ++straight;
    const Vec3 across = p.norm() < 0.6f                     ? Vec3(p.normalized())
                        : std::abs(p.x()) > std::abs(p.y()) ? Vec3(Vec3::UnitX())
                                                            : Vec3(Vec3::UnitY());
    askew += std::abs(direction.dot(across)) > 0.5f;
    EXPECT_LT((point - p).norm(), 4 * apart);
  }
  const double length = 8 + 2 * std::numbers::pi * hole;
  EXPECT_GT(static_cast<double>(straight) * 4 * apart, length) << "none is far from the next";
  EXPECT_LE(askew * 50, straight);
  const auto edges = border_edges(graph, border);
  EXPECT_GT(edges.size(), border.size());
  EXPECT_EQ(border_constraints(border).position.size(),
            static_cast<std::size_t>(std::ranges::count_if(
                border, [](const BorderNode& at) { return !at.direction.isZero(); })));
}

TEST(CloudBorder, ClosedSurfacesHaveNone) {
  Mesh sphere;
  sphere.positions = made::sphere(20000, 1).points;
  EXPECT_TRUE(cloud_border(build_graph(sphere), 0, Context(2)).empty());
  Mesh torus;
  made::Sample shaken = made::torus(200, 100, 1, 0.4);
  shaken.shake(0.01f);
  torus.positions = shaken.points;
  EXPECT_TRUE(cloud_border(build_graph(torus), 0, Context(2)).empty());
}

TEST(CloudBorder, HolesMayBeTooSmall) {
  const Graph graph = build_graph(scattered_square(10000, 0.4f));
  EXPECT_LT(cloud_border(graph, 2, Context(2)).size(), cloud_border(graph, 0, Context(2)).size());
  EXPECT_TRUE(cloud_border(graph, 4, Context(2)).empty());
}

double border_length(const Mesh& mesh) {
  double length = 0;
  for (const auto& [a, b] : border_edges(mesh, Context(1))) {
    length += double{(mesh.positions[a] - mesh.positions[b]).norm()};
  }
  return length;
}

/// Steps would make a border longer by up to two fifths.
TEST(CloudBorder, FacesEndAlongIt) {
  constexpr float hole = 0.4f;
  RemeshOptions options;
  options.face_count = 800;
  const Mesh cloud = scattered_square(20000, hole);
  const double length = 8 + 2 * std::numbers::pi * hole;
  const Mesh aligned = remesh(cloud, options).mesh;
  EXPECT_NEAR(border_length(aligned), length, 0.07 * length);
  options.features.align_border = false;
  EXPECT_GT(border_length(remesh(cloud, options).mesh), 1.1 * border_length(aligned));
}

}  // namespace
}  // namespace meshgrain
