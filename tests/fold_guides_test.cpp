#include "symmetry/fold_guides.h"

#include <gtest/gtest.h>

namespace meshgrain {
namespace {

/// The x of the points of each part, folded to the side above x = 0.
std::vector<std::vector<double>> folded(const std::vector<double>& x, bool closed) {
  Guide guide{{}, closed, 1};
  for (std::size_t k = 0; k < x.size(); ++k) {
    guide.points.push_back({x[k], static_cast<double>(k), 0});
  }
  std::vector<std::vector<double>> result;
  for (const Guide& part : fold_guides({guide}, {0, 0, 0})) {
    EXPECT_EQ(part.strength, guide.strength);
    result.emplace_back();
    for (const auto& p : part.points) result.back().push_back(p.x());
  }
  return result;
}

using Parts = std::vector<std::vector<double>>;

TEST(FoldGuides, ThoseThatCrossThePlaneAreCutThere) {
  EXPECT_EQ(folded({-1, 1}, false), (Parts{{1, 0}, {0, 1}}));
  EXPECT_EQ(folded({1, 2, 3}, false), (Parts{{1, 2, 3}}));
  EXPECT_EQ(folded({-1, -2, 1, 3}, true), (Parts{{0, 1, 3, 0}, {0, 1, 2, 0}}));
}

/// As they are drawn on symmetric models.
TEST(FoldGuides, AlsoAtPointsInThePlane) {
  EXPECT_EQ(folded({-2, 0, 2}, false), (Parts{{2, 0}, {0, 2}}));
  EXPECT_EQ(folded({-2, 0, 0, 2}, false), (Parts{{2, 0, 0}, {0, 2}}));
  EXPECT_EQ(folded({2, 0, -2, 0}, true), (Parts{{0, 2, 0}, {0, 2, 0}}));
}

TEST(FoldGuides, WhatOnlyTouchesThePlaneStaysWhole) {
  EXPECT_EQ(folded({2, 0, 2}, false), (Parts{{2, 0, 2}}));
  EXPECT_EQ(folded({0, 0, 0}, false), (Parts{{0, 0, 0}}));
  EXPECT_EQ(folded({0, -1, -2}, true), (Parts{{0, 1, 2}}));
}

}  // namespace
}  // namespace meshgrain
