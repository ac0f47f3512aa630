// Several nodes at once, on every instruction set that this processor has.

#include <gtest/gtest.h>

#include <numeric>

#include "field/relax_orientations.h"
#include "field/relax_positions.h"
#include "field/rosy.h"
#include "made_graph.h"
#include "util/dispatch.h"

namespace meshgrain {
namespace {

class Lanes : public testing::Test {
 protected:
  void SetUp() override {
    const std::size_t n = graph.size();
    for (Index i = 0; i < n; ++i) {
      const Vec3& normal = graph.normals[i];
      const Vec3 tangent = any_tangent(normal);
      const float angle = 3 * made::noise(i);
      directions.push_back(std::cos(angle) * tangent + std::sin(angle) * normal.cross(tangent));
      points.push_back(graph.positions[i] + 0.2f * made::noise(i + n) * directions[i]);
      lengths.push_back(0.3f + 0.05f * made::noise(i));
      strengths.push_back(i % 3 == 0 ? 0.5f : 0.0f);
    }
    nodes.resize(n);
    std::iota(nodes.begin(), nodes.end(), Index{0});
  }
  void TearDown() override { pretend_simd_targets(0); }

  /// What `relax` gives for all nodes, some at a time.
  template <typename Relax>
  std::vector<Vec3> values(const Relax& relax, std::size_t at_once) const {
    std::vector<Vec3> result(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); k += at_once) {
      const std::span some = std::span(nodes).subspan(k, std::min(at_once, nodes.size() - k));
      relax(some, result.data() + k);
    }
    return result;
  }

  template <typename Relax>
  void expect_same_bytes(const Relax& relax) const {
    const std::int64_t targets = simd_targets();
    const std::vector<Vec3> expected = values(relax, nodes.size());
    for (int bit = 0; bit < 63; ++bit) {
      const std::int64_t target = std::int64_t{1} << bit;
      if ((targets & target) == 0) continue;
      pretend_simd_targets(target);
      for (const std::size_t at_once : {1, 3, 7, 16, 1000}) {
        EXPECT_EQ(values(relax, at_once), expected) << hwy::TargetName(target) << ' ' << at_once;
      }
    }
    pretend_simd_targets(0);
  }

  Graph graph = made::noisy_graph();
  std::vector<Vec3> directions, points;
  std::vector<float> lengths, strengths;
  std::vector<Index> nodes;
};

TEST_F(Lanes, OrientationsDoNotDependOnTheirNumber) {
  const DirectionConstraints constraints{points, strengths};
  for (const int rosy : {1, 2, 4, 6}) {
    for (const auto energy : {OrientationEnergy::extrinsic, OrientationEnergy::intrinsic}) {
      SCOPED_TRACE(rosy);
      expect_same_bytes([&](std::span<const Index> some, Vec3* results) {
        relax_orientations(graph, constraints, rosy, energy, some, directions.data(), results);
      });
    }
  }
}

TEST_F(Lanes, PositionsDoNotDependOnTheirNumber) {
  const LatticeFrame frame{directions, EdgeLength(lengths)};
  const LineConstraints constraints{graph.positions, directions, strengths};
  for (const int posy : {4, 6}) {
    for (const auto energy : {PositionEnergy::extrinsic, PositionEnergy::intrinsic}) {
      SCOPED_TRACE(posy);
      expect_same_bytes([&](std::span<const Index> some, Vec3* results) {
        relax_positions(graph, frame, constraints, posy, energy, some, points.data(), results);
      });
    }
  }
}

TEST(SimdTargets, AreThoseThatTheLibraryFinds) {
  constexpr std::int64_t chosen_from = HWY_AVX3 | HWY_AVX2 | HWY_SSE4;
  EXPECT_EQ(simd_targets() & chosen_from, hwy::SupportedTargets() & chosen_from);
}

}  // namespace
}  // namespace meshgrain
