#include "remesh/flaws.h"

#include <gtest/gtest.h>

#include "remesh/notes.h"

namespace meshgrain {
namespace {

TEST(FaultCounts, AreClearlyFewerByAThirdOrWhereNoFaceIsInverted) {
  EXPECT_TRUE((FaultCounts{0, 6}.are_clearly_fewer_than({0, 10})));
  EXPECT_FALSE((FaultCounts{0, 7}.are_clearly_fewer_than({0, 10})));
  EXPECT_TRUE((FaultCounts{0, 10}.are_clearly_fewer_than({1, 10})));
  EXPECT_FALSE((FaultCounts{1, 0}.are_clearly_fewer_than({0, 100}))) << "an inverted face more";
  EXPECT_FALSE((FaultCounts{2, 9}.are_clearly_fewer_than({2, 10})));
}

TEST(FaultCounts, AreFarMoreBeyondTwiceAsManyAnInvertedFaceBeingAsBadAsTenCrossings) {
  EXPECT_FALSE((FaultCounts{0, 20}.are_far_more_than({0, 10})));
  EXPECT_TRUE((FaultCounts{0, 21}.are_far_more_than({0, 10})));
  EXPECT_TRUE((FaultCounts{2, 1}.are_far_more_than({0, 10})));
  EXPECT_FALSE((FaultCounts{0, 10}.are_far_more_than({1, 0})));
  EXPECT_TRUE((FaultCounts{0, 1}.are_far_more_than({0, 0})));
}

TEST(FaultCounts, AreNeverBothFewerAndFarMore) {
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = 0; b < 60; b += 7) {
      for (std::size_t c = 0; c < 6; ++c) {
        for (std::size_t d = 0; d < 60; d += 7) {
          const FaultCounts now{a, b}, before{c, d};
          EXPECT_FALSE(now.are_clearly_fewer_than(before) && now.are_far_more_than(before))
              << a << "+" << b << " and " << c << "+" << d;
        }
      }
    }
  }
}

TEST(Notes, TellOfFaultsThatAreLeft) {
  const auto notes = [](const FaultCounts& faults) {
    RemeshResult result;
    note_faults(result, faults);
    return result.report.notes;
  };
  EXPECT_TRUE(notes({}).empty());
  EXPECT_EQ(notes({1, 0}).at(0),
            "could not avoid 1 inverted face: more and smaller faces may help");
  EXPECT_EQ(notes({0, 1}).at(0),
            "could not avoid a pair of faces that pass through each other: more and smaller faces "
            "may help");
  EXPECT_EQ(notes({2, 30}).at(0),
            "could not avoid 2 inverted faces, and 30 pairs of faces that pass through each other: "
            "more and smaller faces may help");
}

}  // namespace
}  // namespace meshgrain
