#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "has_note.h"
#include "mesh/cut_apart.h"
#include "meshgrain/statistics.h"
#include "remesh/try_pieces_apart.h"

namespace meshgrain {
namespace {

/// Three triangles that meet on an edge.
Mesh fan() {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, -1, 0)};
  for (const Index apex : {2, 3, 4}) mesh.faces.push_back(std::array<Index, 3>{0, 1, apex});
  return mesh;
}

/// What was made from it, with so many faults.
Made made_with(std::size_t crossings) {
  Made made{};
  made.result.mesh = made.result.fields.surface = fan();
  made.cuts = cut_apart(made.result.fields.surface, Context());
  made.faults.crossings = crossings;
  return made;
}

bool is_noted(const Made& made) {
  return made::has_note(made.result, "left pieces apart");
}

TEST(PiecesApart, SurfacesAreJoinedAgainUnlessTheyAreWantedInPieces) {
  const Made made = made_with(0);
  ASSERT_FALSE(made.cuts.empty());
  EXPECT_EQ(made.surface().positions.size(), 5u);
  EXPECT_EQ(mesh_statistics(made.surface()).components, 1u);
  EXPECT_EQ(mesh_statistics(made.surface_in_pieces()).components, 3u);
}

TEST(PiecesApart, AreTriedWhereThoseThatMeetHaveFaults) {
  std::size_t left = 0;
  int calls = 0;
  Mesh faces = fan();
  const Make make = [&](Mesh input, const RemeshOptions&, const std::optional<Wanted>& wanted,
                        const Context&) {
    ++calls;
    EXPECT_EQ(mesh_statistics(input).components, 3u);
    EXPECT_EQ(wanted.value().fewer_than.crossings, 12u);
    Made other = made_with(left);
    other.cuts = {};
    other.result.mesh = faces;
    return other;
  };
  Made few = made_with(3);
  try_pieces_apart(few, {}, make, Context());
  RemeshOptions in_pieces;
  in_pieces.manifold = true;
  Made many = made_with(12);
  try_pieces_apart(many, in_pieces, make, Context());
  EXPECT_EQ(calls, 0);

  left = 9;
  try_pieces_apart(many, {}, make, Context());
  EXPECT_EQ(calls, 1);
  EXPECT_FALSE(is_noted(many)) << "hardly fewer";

  // None of one piece, but pieces that pass through each other.
  left = 0;
  for (const Vec3& p : {Vec3(0.2f, 0.1f, 0.1f), Vec3(0.2f, -0.1f, 0.1f), Vec3(0.2f, 0, 0.5f)}) {
    faces.positions.push_back(p);
  }
  faces.faces.push_back(std::array<Index, 3>{5, 6, 7});
  ASSERT_FALSE(find_crossings(faces).empty());
  try_pieces_apart(many, {}, make, Context());
  EXPECT_EQ(calls, 2);
  EXPECT_FALSE(is_noted(many));

  faces = fan();
  try_pieces_apart(many, {}, make, Context());
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(is_noted(many) && many.cuts.empty());
  try_pieces_apart(many, {}, make, Context());
  EXPECT_EQ(calls, 3) << "they are apart";
}

}  // namespace
}  // namespace meshgrain
