#include "finish/surface_crossings.h"

#include <gtest/gtest.h>

#include <vector>

#include "meshgrain/shapes.h"
#include "meshgrain/triangulate.h"

namespace meshgrain {
namespace {

/// A unit ball far from two others, which pass through each other around x = 0.65.
Mesh three_balls() {
  const Mesh ball = sample_shape("sphere");
  Mesh balls;
  for (const float x : {-9.0f, 0.0f, 1.3f}) {
    const auto first = static_cast<Index>(balls.positions.size());
    for (const Vec3& p : ball.positions) balls.positions.push_back(p + Vec3(x, 0, 0));
    for (std::size_t f = 0; f < ball.faces.size(); ++f) {
      std::vector<Index> face;
      for (const Index v : ball.faces[f]) face.push_back(first + v);
      balls.faces.push_back(face);
    }
  }
  return triangulate(balls);
}

class SurfaceCrossingsOfThreeBalls : public ::testing::Test {
 protected:
  /// In a box around a point, where the surface hangs together with its vertices there.
  bool cross_near(const Vec3& p, float reach) {
    const Eigen::AlignedBox3f box(p.array() - reach, p.array() + reach);
    std::vector<Index> inside;
    for (Index v = 0; v < surface_.positions.size(); ++v) {
      if (box.contains(surface_.positions[v])) inside.push_back(v);
    }
    return crossings_.any_in(box, std::move(inside));
  }

  const Mesh surface_ = three_balls();
  const VertexFaces around_ = vertex_faces(surface_);
  const Graph graph_ = build_graph(surface_);
  const Projector projector_{surface_, around_, graph_};
  const Context context_;
  SurfaceCrossings crossings_{projector_, context_};
};

TEST_F(SurfaceCrossingsOfThreeBalls, AreFoundWhereTheyAre) {
  // Where the two meet: on a circle of radius sqrt(1 - 0.65^2).
  const Vec3 on_circle(0.65f, 0.76f, 0);
  // Place by place at first, later on out of all that there are: the answers are the same.
  for (int time = 0; time < 50; ++time) {
    EXPECT_TRUE(cross_near(on_circle, 0.2f)) << time;
    EXPECT_FALSE(cross_near({-1, 0, 0}, 0.4f)) << time;
    EXPECT_FALSE(cross_near({-9, 0, 0}, 2)) << time;
    EXPECT_TRUE(cross_near({0.65f, 0, 0}, 3)) << time;
  }
}

TEST_F(SurfaceCrossingsOfThreeBalls, NeedBothSides) {
  // The vertices of one ball alone, which does not hang together with the other.
  const Eigen::AlignedBox3f box(Vec3(0.4f, 0.5f, -0.2f), Vec3(0.9f, 1, 0.2f));
  const std::size_t a_ball = surface_.positions.size() / 3;
  for (int time = 0; time < 50; ++time) {
    std::vector<Index> of_one;
    for (std::size_t v = a_ball; v < 2 * a_ball; ++v) {
      if (box.contains(surface_.positions[v])) of_one.push_back(static_cast<Index>(v));
    }
    ASSERT_FALSE(of_one.empty());
    EXPECT_FALSE(crossings_.any_in(box, std::move(of_one))) << time;
    cross_near({0, 0, 0}, 2);
  }
}

}  // namespace
}  // namespace meshgrain
