#include "util/index_marks.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "made_points.h"

namespace meshgrain {
namespace {

std::vector<Index> take_all(IndexMarks& marks, Index end) {
  std::vector<Index> taken;
  for (Index i = 0; (i = marks.take(i, end)) != no_index; ++i) taken.push_back(i);
  return taken;
}

TEST(IndexMarks, AreTakenInOrderAndOnce) {
  IndexMarks marks;
  for (const Index i : {128u, 63u, 0u, 1000u, 64u, 127u, 63u, 65u}) marks.set(i);
  EXPECT_EQ(take_all(marks, 1001), (std::vector<Index>{0, 63, 64, 65, 127, 128, 1000}));
  EXPECT_TRUE(take_all(marks, 1001).empty());
}

TEST(IndexMarks, NothingIsMarkedAtFirst) {
  IndexMarks marks;
  EXPECT_EQ(marks.take(0, 100), no_index);
  EXPECT_EQ(marks.take(64, 0), no_index);
}

/// From the first or last of a word, and up to it.
TEST(IndexMarks, RangesEndWhereTheySay) {
  for (const Index mark : {62u, 63u, 64u, 65u, 127u, 128u}) {
    for (const Index begin : {0u, 61u, 62u, 63u, 64u, 65u, 127u, 128u, 129u, 200u}) {
      for (const Index end : {0u, 62u, 63u, 64u, 65u, 66u, 127u, 128u, 129u, 200u}) {
        IndexMarks marks;
        marks.set(mark);
        const bool is_within = begin <= mark && mark < end;
        EXPECT_EQ(marks.take(begin, end), is_within ? mark : no_index)
            << mark << " in " << begin << " to " << end;
        // What was not taken is still there.
        EXPECT_EQ(marks.take(0, 200), is_within ? no_index : mark);
      }
    }
  }
}

/// What a loop marks ahead of it comes in the same one; what it marks behind, or where it is,
/// waits.
TEST(IndexMarks, MarksBehindWaitForTheNextLoop) {
  IndexMarks marks;
  marks.set(64);
  std::vector<Index> taken;
  for (Index i = 0; (i = marks.take(i, 300)) != no_index; ++i) {
    taken.push_back(i);
    if (i != 64) continue;
    for (const Index other : {5u, 63u, 64u, 65u, 128u, 299u, 300u}) marks.set(other);
  }
  EXPECT_EQ(taken, (std::vector<Index>{64, 65, 128, 299}));
  EXPECT_EQ(take_all(marks, 300), (std::vector<Index>{5, 63, 64}));
  EXPECT_EQ(take_all(marks, 301), std::vector<Index>{300});
}

TEST(IndexMarks, StayUntilTakenOrCleared) {
  IndexMarks marks;
  for (const Index i : {7u, 64u, 190u}) marks.set(i);
  EXPECT_EQ(marks.first(0), 7u);
  EXPECT_EQ(marks.first(0), 7u);
  EXPECT_EQ(marks.first(8), 64u);
  EXPECT_EQ(marks.first(65, 190), no_index);
  marks.clear(64);
  EXPECT_EQ(marks.first(8), 190u);
  EXPECT_EQ(marks.first(191), no_index);
}

TEST(IndexMarks, AreASet) {
  IndexMarks marks;
  std::set<Index> expected;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const auto i = static_cast<Index>(2000 * (1 + made::noise(k)));
    marks.set(i);
    expected.insert(i);
  }
  EXPECT_EQ(take_all(marks, 4000), std::vector<Index>(expected.begin(), expected.end()));
}

}  // namespace
}  // namespace meshgrain
