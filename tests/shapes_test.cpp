#include "meshgrain/shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "meshgrain/error.h"

namespace meshgrain {
namespace {

struct Expected {
  const char* name;
  long euler;
  double volume;  // of the smooth shape; 0 where it is not known
};

class SampleShape : public testing::TestWithParam<Expected> {};

double least_angle(const Mesh& mesh) {
  double least = 180;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto t = mesh.faces[f];
      const Vec3 a = mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]];
      const Vec3 b = mesh.positions[t[(k + 2) % 3]] - mesh.positions[t[k]];
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI);
    }
  return least;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto t = mesh.faces[f];
    sum += mesh.positions[t[0]].cross(mesh.positions[t[1]]).dot(mesh.positions[t[2]]) / 6;
  }
  return sum;
}

TEST_P(SampleShape, IsAnOrientedManifoldOfItsEulerNumber) {
  for (double resolution : {0.5, 1.0, 1.3, 1.7}) {
    const Mesh mesh = sample_shape(GetParam().name, resolution);
    ASSERT_EQ(mesh.faces.uniform_degree(), 3u);
    std::set<std::pair<Index, Index>> halfedges;
    std::map<Index, std::map<Index, Index>>
        around;  // vertex, then from neighbour to next neighbour
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (int k = 0; k < 3; ++k) {
        const auto t = mesh.faces[f];
        EXPECT_TRUE(halfedges.emplace(t[k], t[(k + 1) % 3]).second);
        around[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3];
      }
    long edges = 0, borders = 0;
    for (auto [a, b] : halfedges) {
      const bool twin = halfedges.count({b, a}) > 0;
      borders += !twin;
      edges += !twin || a < b;
    }
    EXPECT_EQ(borders > 0, std::string(GetParam().name) == "plate");
    EXPECT_EQ(around.size(), mesh.positions.size()) << "a vertex without faces";
    if (borders == 0)
      for (const auto& [v, next] : around) {
        std::size_t steps = 0;
        Index w = next.begin()->first;
        do w = next.at(w), ++steps;
        while (w != next.begin()->first && steps <= next.size());
        EXPECT_EQ(steps, next.size()) << "the faces around vertex " << v << " are not one fan";
      }
    EXPECT_EQ(long(mesh.positions.size()) - edges + long(mesh.faces.size()), GetParam().euler);
  }
}

TEST_P(SampleShape, FacesOutAndHasNoSlivers) {
  const Mesh mesh = sample_shape(GetParam().name);
  EXPECT_GT(least_angle(mesh), 15);
  EXPECT_GT(mesh.positions.size(), 500u);
  EXPECT_LT(mesh.positions.size(), 20000u);
  if (std::string(GetParam().name) == "plate") return;
  EXPECT_GT(volume(mesh), 0);
  const double expected = GetParam().volume > 0 ? GetParam().volume : volume(mesh);
  EXPECT_NEAR(volume(mesh) / expected, 1, 0.015);
}

TEST_P(SampleShape, ScalesWithTheResolution) {
  const double one = double(sample_shape(GetParam().name, 1).faces.size());
  const double half = double(sample_shape(GetParam().name, 0.5).faces.size());
  EXPECT_NEAR(one / half, 4, 0.2);
}

INSTANTIATE_TEST_SUITE_P(All, SampleShape,
                         testing::Values(Expected{"bracket", 0, 0}, Expected{"cube", 2, 1},
                                         Expected{"twisted-cube", 2, 1},
                                         Expected{"fused-boxes", 2, 1.8},
                                         Expected{"cylinder", 2, M_PI / 4}, Expected{"shaft", 2, 0},
                                         Expected{"sphere", 2, 4 * M_PI / 3},
                                         Expected{"torus", 0, 2 * M_PI* M_PI * 0.16},
                                         Expected{"three-holes", -4, 0}, Expected{"blob", 2, 0},
                                         Expected{"plate", 1, 0}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(SampleShapes, KnowsItsNames) {
  EXPECT_EQ(sample_names().size(), 11u);
  for (const std::string& name : sample_names())
    EXPECT_FALSE(sample_shape(name, 0.3).faces.empty());
  try {
    sample_shape("teacup");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("teacup"), std::string::npos);
    for (const std::string& name : sample_names())
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
  }
}

TEST(SampleShapes, RefusesImpossibleResolutions) {
  for (double resolution : {0.0, -1.0, 1e9, std::nan("")})
    EXPECT_THROW(sample_shape("cube", resolution), Error);
}

}  // namespace
}  // namespace meshgrain
