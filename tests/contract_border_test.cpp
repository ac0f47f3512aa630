#include "mesh/contract_border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "has_note.h"
#include "mesh/border.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"

namespace meshgrain {
namespace {

/// A sphere of quads as many programs write it: with a vertex for each meridian at the poles.
Mesh sphere_with_poles() {
  constexpr Index around = 24, rows = 12;
  const auto angle = [](Index k, Index count) {
    return std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(count);
  };
  Mesh mesh;
  for (Index j = 0; j <= rows; ++j) {
    const float radius = j == 0 || j == rows ? 0 : std::sin(angle(j, rows));
    for (Index i = 0; i < around; ++i) {
      const float turn = 2 * angle(i, around);
      mesh.positions.emplace_back(radius * std::cos(turn), radius * std::sin(turn),
                                  std::cos(angle(j, rows)));
    }
  }
  for (Index j = 0; j < rows; ++j) {
    for (Index i = 0; i < around; ++i) {
      const Index a = j * around + i, b = j * around + (i + 1) % around;
      mesh.faces.push_back({a, a + around, b + around, b});
    }
  }
  return mesh;
}

TEST(ContractBorder, HolesOfNoSizeAreClosed) {
  Mesh mesh = sphere_with_poles();
  ASSERT_EQ(mesh_statistics(mesh).boundary_loops, 2u);
  auto border = border_edges(mesh);
  EXPECT_EQ(contract_border(mesh, border, Context()), 46u);
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_EQ(s.vertices, 266u);
  EXPECT_EQ(s.faces, 288u);
  EXPECT_EQ(s.euler, 2);
  EXPECT_EQ(s.boundary_loops, 0u);
  EXPECT_TRUE(border.empty());
  EXPECT_EQ(contract_border(mesh, border, Context()), 0u);
}

/// Such holes made points that are no numbers, and a search for edges short enough without end.
TEST(ContractBorder, PolesAreRemeshed) {
  const Mesh mesh = sphere_with_poles();
  for (const bool lock_borders : {false, true}) {
    for (const int smoothing : {0, 32}) {
      RemeshOptions options;
      options.face_count = 100;
      options.lock_borders = lock_borders;
      options.smoothing = smoothing;
      const RemeshResult result = remesh(mesh, options);
      EXPECT_TRUE(
          std::ranges::all_of(result.mesh.positions, [](const Vec3& p) { return p.allFinite(); }));
      const MeshStatistics s = mesh_statistics(result.mesh);
      EXPECT_EQ(s.euler, 2);
      EXPECT_EQ(s.boundary_loops, 0u);
      EXPECT_NEAR(static_cast<double>(s.faces), 100, 2);
      EXPECT_TRUE(made::has_note(result, "merged 46 vertices of the border"));
    }
  }
}

}  // namespace
}  // namespace meshgrain
