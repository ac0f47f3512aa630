#include <gtest/gtest.h>

#include <optional>

#include "has_note.h"
#include "meshgrain/shapes.h"
#include "remesh/try_no_creases.h"

namespace meshgrain {
namespace {

/// A mesh with so many inverted faces.
Made made_with(std::size_t inverted) {
  Made made{};
  made.result.mesh = made.result.fields.surface = sample_shape("cube");
  made.result.fields.surface.marked_edges = {{0, 1}};  // of a crease that was found
  made.faults.inverted = inverted;
  return made;
}

bool is_noted(const Made& made) {
  return made::has_note(made.result, "without creases: ");
}

TEST(NoCreases, AreTriedWhereFacesThatFollowSomeAreInverted) {
  std::size_t left = 0;
  int calls = 0;
  const Make make = [&](Mesh input, const RemeshOptions& options,
                        const std::optional<Wanted>& wanted, const Context&) {
    ++calls;
    EXPECT_FALSE(input.faces.empty());
    EXPECT_TRUE(input.marked_edges.empty());
    EXPECT_EQ(options.features.creases, Creases::none);
    EXPECT_EQ(wanted.value().fewer_than.inverted, 2u);
    return made_with(left);
  };
  Made made = made_with(2);
  try_no_creases(made, {}, make, Context());
  EXPECT_EQ(calls, 0);  // they follow none

  made.follows_creases = true;
  left = 2;
  try_no_creases(made, {}, make, Context());
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(made.follows_creases && !made.is_without_creases() && !is_noted(made));

  left = 0;
  try_no_creases(made, {}, make, Context());
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(made.faults.inverted, 0u);
  EXPECT_TRUE(made.is_without_creases() && !made.follows_creases && is_noted(made));
  try_no_creases(made, {}, make, Context());
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace meshgrain
