#include "remesh/count_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meshgrain {
namespace {

/// How many attempts it takes to come within a hundredth where a lattice has so many times the
/// faces that are wanted, as logarithms: `more` + `slope` * what is asked for.
int attempts(double more, double slope) {
  CountSearch search;
  for (int count = 1; count <= 20; ++count) {
    const double got = more + slope * search.asked();
    if (std::abs(got) < 0.01) return count;
    search.go_on(std::exp(got), 1);
  }
  return 21;
}

TEST(CountSearch, FindsWhatIsInProportionAtOnce) {
  EXPECT_EQ(attempts(0.3, 1), 2);
  EXPECT_EQ(attempts(-1.2, 1), 2);
}

/// As with creases so close that faces have a size of their own there.
TEST(CountSearch, FindsWhatHardlyChanges) {
  EXPECT_LE(attempts(0.6, 0.5), 6);
  EXPECT_LE(attempts(0.9, 0.35), 9);
}

/// Lines and holes need so many, whatever is asked for; but fewer attempts do not tell.
TEST(CountSearch, GivesUpWhereNothingChanges) {
  const auto attempts_until_in_vain = [](double more, double slope) {
    CountSearch search;
    for (int count = 1; count <= 20; ++count) {
      const double noise = count % 2 == 0 ? 0.05 : -0.05;
      search.go_on(std::exp(more + slope * search.asked() + noise), 1);
      if (search.is_in_vain()) return count;
      if (std::abs(more + slope * search.asked()) < 0.01) break;
    }
    return 0;
  };
  EXPECT_EQ(attempts_until_in_vain(1, 0), 3);
  EXPECT_EQ(attempts_until_in_vain(3.6, 0), 3);
  EXPECT_EQ(attempts_until_in_vain(0.6, 0.5), 0);
  EXPECT_EQ(attempts_until_in_vain(0.9, 0.35), 0);
  EXPECT_EQ(attempts_until_in_vain(-0.9, 0), 0);  // too few
}

/// Chance must not be taken for a slope.
TEST(CountSearch, StaysNearTheMeanOfAttemptsThatLieClose) {
  CountSearch search;
  for (const double error : {0.03, -0.02, 0.025, -0.035}) {
    search.go_on(std::exp(search.asked() + error), 1);
    EXPECT_LT(std::abs(search.asked()), 0.031);
  }
}

TEST(CountSearch, AsksForMoreWhereThereIsNothing) {
  CountSearch search;
  search.go_on(0, 1);
  EXPECT_GT(search.asked(), 1);
  EXPECT_TRUE(std::isfinite(search.asked()));
}

}  // namespace
}  // namespace meshgrain
