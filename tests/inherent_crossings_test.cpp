#include "remesh/inherent_crossings.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "made_cells.h"
#include "meshgrain/shapes.h"
#include "meshgrain/triangulate.h"

namespace meshgrain {
namespace {

/// Two unit cubes, the second one moved; its first vertex comes after all of the first one.
Mesh two_cubes(const Vec3& moved) {
  Mesh cubes = sample_shape("cube");
  const Mesh other = cubes;
  const auto count = static_cast<Index>(cubes.positions.size());
  for (const Vec3& p : other.positions) cubes.positions.push_back(p + moved);
  for (std::size_t f = 0; f < other.faces.size(); ++f) {
    std::vector<Index> face;
    for (const Index v : other.faces[f]) face.push_back(v + count);
    cubes.faces.push_back(face);
  }
  return triangulate(cubes);
}

constexpr double side = 0.2;  // of a face of a mesh that is made

class InherentCrossingsOfTwoCubes : public ::testing::Test {
 protected:
  bool touch(const Vec3& moved) {
    const Mesh cubes = two_cubes(moved);
    InherentCrossings inherent(cubes, cuts_, side, Context());
    const Index last = static_cast<Index>(cubes.positions.size()) - 1;
    EXPECT_FALSE(inherent.do_touch(0, 1)) << "a piece and itself";
    EXPECT_FALSE(inherent.do_touch(last, last - 1));
    EXPECT_EQ(inherent.do_touch(0, last), inherent.do_touch(last, 0));
    return inherent.do_touch(0, last);
  }

  Cuts cuts_;
};

TEST_F(InherentCrossingsOfTwoCubes, TouchWhereTheyLieOnEachOther) {
  EXPECT_TRUE(touch({1, 0, 0}));
  EXPECT_TRUE(touch({0.37f, 0.21f, 1}));
}

TEST_F(InherentCrossingsOfTwoCubes, TouchWhereHardlyAnythingIsBetweenThem) {
  EXPECT_TRUE(touch({0, 1 + 0.04f * static_cast<float>(side), 0}));
}

TEST_F(InherentCrossingsOfTwoCubes, DoNotTouchWhereAFaceCouldTell) {
  EXPECT_FALSE(touch({0, 1 + 0.2f * static_cast<float>(side), 0}));
  EXPECT_FALSE(touch({3, 0, 0}));
}

TEST_F(InherentCrossingsOfTwoCubes, AreOnePieceIfTheyWereCutApart) {
  Mesh cubes = triangulate(made::surface_of_cells({{0, 0, 0}, {1, 1, 0}}));
  const Cuts cuts = cut_apart(cubes, Context());
  const auto last = static_cast<Index>(cubes.positions.size()) - 1;
  ASSERT_NE(cuts.sources[last], last);
  InherentCrossings inherent(cubes, cuts, side, Context());
  for (Index v = 0; v < last; ++v) EXPECT_FALSE(inherent.do_touch(v, last));
}

TEST_F(InherentCrossingsOfTwoCubes, PassThroughEachOtherNearTheirCrossingAlone) {
  const Mesh cubes = two_cubes({0.53f, 0.47f, 0.51f});
  const InherentCrossings inherent(cubes, cuts_, side, Context());
  const auto at = [&](const Vec3& corner) {  // two small triangles that meet there
    Mesh mesh;
    const auto p = [&](float x, float y, float z) {
      mesh.positions.push_back(corner + 0.05f * Vec3(x, y, z));
    };
    p(-1, -1, 0), p(1, -1, 0), p(0, 1, 0), p(0, -1, -1), p(0, -1, 1), p(0, 1, 0.5f);
    mesh.faces.push_back({0u, 1u, 2u});
    mesh.faces.push_back({3u, 4u, 5u});
    return inherent.are_near(mesh, {0, 1});
  };
  const Mesh first = sample_shape("cube");
  Vec3 low = first.positions[0], high = low;
  for (const Vec3& p : first.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  // The far side of the first cube is where one corner of the second one is inside of it.
  EXPECT_TRUE(at({high.x(), low.y() + 0.75f, low.z() + 0.51f}));
  EXPECT_FALSE(at(low));
}

}  // namespace
}  // namespace meshgrain
