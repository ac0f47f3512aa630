#include "finish/crossing_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "finish/crossing_guard.h"
#include "measure/crossings.h"
#include "meshgrain/shapes.h"

namespace meshgrain {
namespace {

/// A torus whose vertices have been shaken, so that many faces pass through each other.
class Shaken {
 public:
  Mesh mesh = sample_shape("torus");

  /// Some of the vertices, by up to `most` along each axis.
  void shake(double share, float most) {
    std::uniform_real_distribution<float> way(-most, most);
    std::bernoulli_distribution moves(share);
    for (Vec3& p : mesh.positions) {
      if (moves(random_)) p += Vec3(way(random_), way(random_), way(random_));
    }
  }

 private:
  std::mt19937 random_{1};
};

TEST(CrossingPairs, AreThoseOfAllFacesAfterSomeHaveMoved) {
  Shaken shaken;
  shaken.shake(1, 0.03f);
  CrossingPairs pairs(shaken.mesh, Context());
  const std::size_t first = pairs.all().size();
  EXPECT_GT(first, 10u);
  EXPECT_FALSE(pairs.update()) << "nothing has moved";
  for (const double share : {0.001, 0.02, 0.3}) {
    shaken.shake(share, 0.06f);
    EXPECT_TRUE(pairs.update());
    EXPECT_EQ(pairs.all(), find_crossings(shaken.mesh, Context())) << share;
  }
  EXPECT_NE(pairs.all().size(), first);
}

TEST(CrossingGuard, LetsVerticesMoveOnlyWhereNoFacesComeToCross) {
  Shaken shaken;
  shaken.shake(1, 0.02f);
  const auto before = find_crossings(shaken.mesh, Context());
  const std::vector<Vec3> start = shaken.mesh.positions;
  std::vector<Index> all_faces(shaken.mesh.faces.size());
  std::iota(all_faces.begin(), all_faces.end(), Index{0});
  CrossingGuard guard(shaken.mesh, all_faces, Context());
  shaken.shake(0.05, 0.05f);
  const std::vector<Vec3> asked = shaken.mesh.positions;
  guard.undo_new();
  for (const auto& pair : find_crossings(shaken.mesh, Context())) {
    EXPECT_TRUE(std::ranges::binary_search(before, pair));
  }
  std::size_t moved = 0, undone = 0;
  for (std::size_t v = 0; v < start.size(); ++v) {
    moved += asked[v] != start[v] && shaken.mesh.positions[v] == asked[v];
    undone += asked[v] != start[v] && shaken.mesh.positions[v] == start[v];
  }
  EXPECT_GT(moved, 0u);
  EXPECT_GT(undone, 0u);
}

}  // namespace
}  // namespace meshgrain
