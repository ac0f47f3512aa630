#include "cloud/nearest_neighbors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "made_points.h"

namespace meshgrain {
namespace {

std::vector<Index> by_hand(const std::vector<Vec3>& points, std::size_t i, std::size_t k) {
  std::vector<std::pair<float, Index>> all;
  for (Index j = 0; j < points.size(); ++j) {
    bool first = points[j] != points[i];
    for (Index l = 0; l < j; ++l) first = first && points[l] != points[j];
    if (first) all.emplace_back((points[j] - points[i]).squaredNorm(), j);
  }
  std::sort(all.begin(), all.end());
  std::vector<Index> result;
  for (std::size_t n = 0; n < std::min(k, all.size()); ++n) result.push_back(all[n].second);
  return result;
}

void expect_same_as_by_hand(const std::vector<Vec3>& points, std::size_t k) {
  const Neighborhoods found = nearest_neighbors(points, k, Context(3));
  ASSERT_EQ(found.indices.size(), points.size() * k);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<Index> list(found[i].begin(), found[i].end());
    EXPECT_EQ(list, by_hand(points, i, k)) << "point " << i;
  }
}

TEST(NearestNeighbors, AgreesWithAllPairs) {
  std::vector<Vec3> points;
  for (std::uint64_t i = 0; i < 400; ++i)
    points.emplace_back(made::noise(3 * i), made::noise(3 * i + 1), made::noise(3 * i + 2));
  expect_same_as_by_hand(points, 7);
}

TEST(NearestNeighbors, BreaksTiesByIndex) {
  std::vector<Vec3> grid;
  for (int i = 0; i < 343; ++i) {
    const int j = i * 100 % 343;  // visits all, in no spatial order
    grid.emplace_back(j % 7, j / 7 % 7, j / 49);
  }
  expect_same_as_by_hand(grid, 5);
}

TEST(NearestNeighbors, DuplicatesDoNotFillTheNeighborhood) {
  std::vector<Vec3> points;
  for (int i = 0; i < 20; ++i)
    for (int copy = 0; copy < 9; ++copy) points.emplace_back(i, 0, copy % 2 == 0 ? 0.0f : -0.0f);
  expect_same_as_by_hand(points, 4);
}

TEST(NearestNeighbors, ManyEqualPointsTakeNoQuadraticTime) {
  std::vector<Vec3> points(300000, Vec3(1, 2, 3));
  points.emplace_back(0, 0, 0);
  const Neighborhoods found = nearest_neighbors(points, 3);
  ASSERT_EQ(found[7].size(), 1u);
  EXPECT_EQ(found[7][0], 300000u);
  EXPECT_EQ(found[300000][0], 0u);
}

TEST(NearestNeighbors, FewPointsLeavePlacesEmpty) {
  EXPECT_TRUE(nearest_neighbors({}, 4).indices.empty());
  const std::vector<Vec3> two{{0, 0, 0}, {1, 0, 0}};
  const Neighborhoods found = nearest_neighbors(two, 3);
  EXPECT_EQ(found.indices, (std::vector<Index>{1, no_index, no_index, 0, no_index, no_index}));
  EXPECT_TRUE(nearest_neighbors(two, 0)[1].empty());
}

}  // namespace
}  // namespace meshgrain
