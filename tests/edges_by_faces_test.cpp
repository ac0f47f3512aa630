#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "mesh/border.h"
#include "meshgrain/shapes.h"
#include "util/dispatch.h"

namespace meshgrain {
namespace {

constexpr double degrees = 20;

/// The faces along every edge of a mesh of triangles, by the smaller index first.
struct Sides {
  std::vector<Index> forth, back;
};
using EdgeSides = std::map<std::array<Index, 2>, Sides>;

EdgeSides sides_of(const Mesh& mesh) {
  EdgeSides edges;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = face[k], b = face[(k + 1) % 3];
      (a < b ? edges[{a, b}].forth : edges[{b, a}].back).push_back(f);
    }
  }
  return edges;
}

bool is_simple(const Sides& sides) {
  return sides.forth.size() == 1 && sides.back.size() == 1;
}

std::vector<std::array<Index, 2>> rim(const EdgeSides& edges) {
  std::vector<std::array<Index, 2>> result;
  for (const auto& [ends, sides] : edges) {
    if (!is_simple(sides)) result.push_back(ends);
  }
  return result;
}

Vec3 normal_of(const Mesh& mesh, Index f) {
  const auto face = mesh.faces[f];
  const Vec3 &a = mesh.positions[face[0]], &b = mesh.positions[face[1]],
             &c = mesh.positions[face[2]];
  return (b - a).cross(c - a).normalized();
}

std::vector<std::array<Index, 2>> sharp(const Mesh& mesh, const EdgeSides& edges) {
  const double flattest = std::cos(degrees * std::numbers::pi / 180);
  std::vector<std::array<Index, 2>> result;
  for (const auto& [ends, sides] : edges) {
    if (!is_simple(sides)) continue;
    const Vec3 left = normal_of(mesh, sides.forth[0]), right = normal_of(mesh, sides.back[0]);
    if (left.dot(right) < flattest) result.push_back(ends);
  }
  return result;
}

/// A bumpy surface with all that there can be at an edge: some faces left out, turned over, there
/// twice, or with other corners, and a fan of more faces than are looked at side by side.
Mesh odd_mesh(std::uint32_t seed) {
  const Mesh whole = sample_shape("blob", 1);
  std::minstd_rand random(seed);
  const auto one_in = [&](std::uint32_t n) { return random() % n == 0; };
  const auto any_vertex = [&] { return static_cast<Index>(random() % whole.positions.size()); };
  Mesh mesh;
  mesh.positions = whole.positions;
  for (Vec3& p : mesh.positions) p *= 1 + 1e-3f * static_cast<float>(random() % 50);
  for (Index f = 0; f < whole.faces.size(); ++f) {
    std::array<Index, 3> face{whole.faces[f][0], whole.faces[f][1], whole.faces[f][2]};
    if (one_in(20)) continue;
    if (one_in(20)) std::swap(face[0], face[1]);
    mesh.faces.push_back({face[0], face[1], face[2]});
    if (one_in(20)) mesh.faces.push_back({face[1], face[2], face[0]});
    const Index other = any_vertex();
    if (other != face[0] && other != face[1] && one_in(20)) {
      mesh.faces.push_back({face[0], face[1], other});
    }
  }
  const auto center = static_cast<Index>(mesh.positions.size());
  constexpr Index around = 12;
  mesh.positions.emplace_back(9, 0, 0.5f);
  for (Index k = 0; k < around; ++k) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / around;
    mesh.positions.emplace_back(9 + std::cos(angle), std::sin(angle), 0);
    mesh.faces.push_back({center, center + 1 + k, center + 1 + (k + 1) % around});
  }
  return mesh;
}

/// Calls `body` with each instruction set that the processor has, by itself.
template <typename Body>
void for_each_target(const Body& body) {
  const std::int64_t targets = simd_targets();
  for (int bit = 0; bit < 63; ++bit) {
    const std::int64_t target = std::int64_t{1} << bit;
    if ((targets & target) == 0) continue;
    SCOPED_TRACE(hwy::TargetName(target));
    pretend_simd_targets(target);
    body();
  }
  pretend_simd_targets(0);
}

TEST(EdgesByFaces, AreThoseOfAPlainCount) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Mesh mesh = odd_mesh(seed);
    const EdgeSides edges = sides_of(mesh);
    const auto expected_rim = rim(edges), expected_sharp = sharp(mesh, edges);
    ASSERT_GT(expected_rim.size(), 100);
    ASSERT_GT(expected_sharp.size(), 100);
    ASSERT_LT(expected_sharp.size(), edges.size() / 2);
    for_each_target([&] {
      const RimAndSharpEdges found = rim_and_sharp_edges(mesh, degrees, Context(2));
      EXPECT_EQ(found.rim, expected_rim);
      EXPECT_EQ(rim_edges(mesh), expected_rim);
      EXPECT_EQ(crease_edges(mesh, degrees), expected_sharp);
    });
  }
}

TEST(EdgesByFaces, BordersRunAsTheirFacesDo) {
  const Mesh mesh = odd_mesh(6);
  std::vector<std::array<Index, 2>> expected;
  for (const auto& [ends, sides] : sides_of(mesh)) {
    if (sides.forth.size() + sides.back.size() != 1) continue;
    expected.push_back(sides.back.empty() ? ends : std::array{ends[1], ends[0]});
  }
  for_each_target([&] { EXPECT_EQ(border_edges(mesh), expected); });
}

}  // namespace
}  // namespace meshgrain
