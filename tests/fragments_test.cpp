#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "features/leave_out_fragments.h"
#include "meshgrain/features.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

using Edge = std::array<Index, 2>;
using Edges = std::vector<Edge>;

/// Points one apart, and lines from one to the next.
class Fragments : public ::testing::Test {
 protected:
  static constexpr Index width = 60, height = 30;

  Fragments() {
    for (Index y = 0; y < height; ++y) {
      for (Index x = 0; x < width; ++x) {
        grid.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
      }
    }
  }

  static Edges line(Index x0, Index y0, Index x1, Index y1) {
    Edges edges;
    for (Index x = std::min(x0, x1); x < std::max(x0, x1); ++x) {
      edges.push_back({y0 * width + x, y0 * width + x + 1});
    }
    for (Index y = std::min(y0, y1); y < std::max(y0, y1); ++y) {
      edges.push_back({y * width + x1, (y + 1) * width + x1});
    }
    return edges;
  }
  static Edges all_of(std::initializer_list<Edges> lines) {
    Edges all;
    for (const Edges& line : lines) all.insert(all.end(), line.begin(), line.end());
    std::ranges::sort(all);
    return all;
  }
  Edges left(const Edges& creases, const Edges& rim = {}) const {
    return leave_out_fragments(grid, rim, creases, side);
  }

  static constexpr double side = 5;
  Mesh grid;
};

TEST_F(Fragments, LongLinesStay) {
  const Edges creases = all_of({line(0, 3, 59, 3), line(5, 20, 40, 20)});
  EXPECT_EQ(left(creases), creases);
}

TEST_F(Fragments, ShortOnesGo) {
  const Edges ring = all_of(
      {line(40, 10, 42, 10), line(42, 10, 42, 13), line(40, 13, 42, 13), line(40, 10, 40, 13)});
  EXPECT_TRUE(left(line(10, 10, 18, 10)).empty());
  EXPECT_TRUE(left(ring).empty());
}

/// What hung on a twig of a twig goes with these.
TEST_F(Fragments, TwigsGo) {
  const Edges trunk = line(0, 15, 59, 15);
  EXPECT_EQ(left(all_of({trunk, line(20, 15, 20, 22), line(20, 22, 26, 22)})), trunk);
  const Edges branch = line(20, 15, 20, 29);
  EXPECT_EQ(left(all_of({trunk, branch})), all_of({trunk, branch}));
}

TEST_F(Fragments, OnesCrowdedByLongerOnesGo) {
  const Edges longest = line(0, 10, 59, 10), far = line(10, 15, 59, 15);
  EXPECT_EQ(left(all_of({longest, line(10, 12, 50, 12), far})), all_of({longest, far}));
}

TEST_F(Fragments, ThoseThatEndAtTheRimLeadSomewhere) {
  const Edges rim = line(0, 0, 59, 0);
  const Edges between = line(30, 0, 30, 18);
  const Edges both = all_of({between, line(10, 18, 50, 18)});
  EXPECT_EQ(left(both, rim), both);
}

/// The hills of a bumpy ball are sharp all over: faces far larger than these cannot follow.
TEST(FragmentsOfSculptures, DoNotSpoilTheFaces) {
  Mesh bumpy = sample_shape("blob", 2);
  for (std::size_t v = 0; v < bumpy.positions.size(); ++v) {
    bumpy.positions[v] *= 1 + 0.01f * static_cast<float>((v * 2654435761U >> 7U) % 8) / 8;
  }
  RemeshOptions options;
  options.face_count = 600;
  options.features.creases = Creases::by_angle;
  options.features.crease_degrees = 15;
  const auto followed = [&](double edge_length) {
    return find_features(bumpy, options.features, edge_length, Context()).vertices.size();
  };
  ASSERT_GT(followed(0), 200u);  // by faces of no size: all of them
  EXPECT_LT(followed(0.3), followed(0) / 4);
  const RemeshResult result = remesh(bumpy, options);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.inverted_quads, 0u);
  EXPECT_NEAR(static_cast<double>(s.faces), 600, 6);
  EXPECT_EQ(s.euler, mesh_statistics(bumpy).euler);
}

}  // namespace
}  // namespace meshgrain
