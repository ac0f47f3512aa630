#include "measure/face_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "measure/crossings.h"

namespace meshgrain {
namespace {

/// Triangles that are up to `ratio` times as large as others.
Mesh triangles_of_many_sizes(std::size_t count, float ratio) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1, 1), power(0, 1);
  Mesh mesh;
  for (Index t = 0; t < count; ++t) {
    const Vec3 middle(place(random), place(random), place(random));
    const float size = 2 * std::pow(ratio, -power(random));
    for (int corner = 0; corner < 3; ++corner) {
      mesh.positions.push_back(middle + size * Vec3(place(random), place(random), place(random)));
    }
    mesh.faces.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

std::vector<std::array<Index, 2>> all_crossings(const Mesh& mesh) {
  std::vector<std::array<Index, 2>> pairs;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index g = f + 1; g < mesh.faces.size(); ++g) {
      if (penetration(mesh, f, g) > 0) pairs.push_back({f, g});
    }
  }
  return pairs;
}

TEST(FaceGrid, EachPairIsFoundOnceWhateverTheSizes) {
  for (const float ratio : {2.0f, 100.0f, 1e5f}) {
    const Mesh mesh = triangles_of_many_sizes(600, ratio);
    const auto expected = all_crossings(mesh);
    EXPECT_GT(expected.size(), 100u);
    EXPECT_EQ(find_crossings(mesh, Context()), expected) << ratio;
    EXPECT_EQ(FaceGrid(mesh, Context()).has_large_faces(), ratio > 2);
  }
}

/// In a single grid of small cells the large triangle would take gigabytes.
TEST(FaceGrid, FewLargeFacesBesideManySmallOnesTakeFewCells) {
  Mesh mesh = triangles_of_many_sizes(20000, 1);
  for (Vec3& p : mesh.positions) p *= 1e-4f;
  const auto first = static_cast<Index>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {Vec3(-3, -2, -1), Vec3(2, 3, 1), Vec3(1, -1, 2)});
  mesh.faces.push_back({first, first + 1, first + 2});
  const FaceGrid grid(mesh, Context());
  EXPECT_TRUE(grid.has_large_faces());
  EXPECT_LT(grid.entries(), 64 * mesh.faces.size());
}

}  // namespace
}  // namespace meshgrain
