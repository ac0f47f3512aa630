#include "meshgrain/hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "made_graph.h"
#include "util/hash.h"

namespace meshgrain {
namespace {

/// Of unit area each, all normals up, with these (undirected) edges.
Graph made_graph(std::size_t nodes, const std::vector<std::array<Index, 2>>& edges) {
  std::vector<std::vector<Index>> around(nodes);
  for (const auto& [a, b] : edges) {
    around[a].push_back(b);
    around[b].push_back(a);
  }
  Graph graph;
  graph.offsets.push_back(0);
  for (std::size_t i = 0; i < nodes; ++i) {
    graph.positions.emplace_back(made::noise(i), made::noise(2 * i), 0);
    graph.normals.push_back(Vec3::UnitZ());
    graph.areas.push_back(1);
    std::sort(around[i].begin(), around[i].end());
    graph.neighbors.insert(graph.neighbors.end(), around[i].begin(), around[i].end());
    graph.offsets.push_back(static_cast<Index>(graph.neighbors.size()));
  }
  return graph;
}

std::size_t count_components(const Graph& graph) {
  std::vector<Index> label(graph.size(), no_index), stack;
  std::size_t count = 0;
  for (Index seed = 0; seed < graph.size(); ++seed) {
    if (label[seed] != no_index) continue;
    label[seed] = static_cast<Index>(count++);
    stack.push_back(seed);
    while (!stack.empty()) {
      const Index i = stack.back();
      stack.pop_back();
      for (const Index j : graph.neighbors_of(i)) {
        if (label[j] == no_index) {
          label[j] = label[i];
          stack.push_back(j);
        }
      }
    }
  }
  return count;
}

double total(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void expect_consistent(const Hierarchy& hierarchy) {
  ASSERT_FALSE(hierarchy.levels.empty());
  ASSERT_EQ(hierarchy.parents.size() + 1, hierarchy.levels.size());
  const double area = total(hierarchy.levels[0].areas);
  for (std::size_t l = 0; l + 1 < hierarchy.levels.size(); ++l) {
    SCOPED_TRACE("level " + std::to_string(l));
    const Graph &fine = hierarchy.levels[l], &coarse = hierarchy.levels[l + 1];
    const std::vector<Index>& parents = hierarchy.parents[l];
    ASSERT_EQ(parents.size(), fine.size());
    ASSERT_EQ(hierarchy.children[l].size(), coarse.size());
    ASSERT_EQ(hierarchy.children[l].nodes.size(), fine.size());
    for (Index k = 0; k < coarse.size(); ++k) {
      const auto children_of = hierarchy.children[l][k];
      EXPECT_TRUE(std::ranges::is_sorted(children_of));
      for (const Index i : children_of) EXPECT_EQ(parents[i], k);
    }
    std::vector<double> areas(coarse.size(), 0);
    std::vector<Eigen::Vector3d> positions(coarse.size(), Eigen::Vector3d::Zero());
    std::vector<std::size_t> children(coarse.size(), 0);
    std::size_t isolated = 0;
    for (Index i = 0; i < fine.size(); ++i) {
      ASSERT_LT(parents[i], coarse.size());
      areas[parents[i]] += fine.areas[i];
      positions[parents[i]] += fine.areas[i] * fine.positions[i].cast<double>();
      ++children[parents[i]];
      isolated += fine.neighbors_of(i).empty();
    }
    for (Index k = 0; k < coarse.size(); ++k) {
      ASSERT_GT(children[k], 0u);
      ASSERT_NEAR(coarse.areas[k], areas[k], 1e-4 * areas[k]);
      ASSERT_LT((coarse.positions[k].cast<double>() - positions[k] / areas[k]).norm(), 1e-3);
      ASSERT_NEAR(coarse.normals[k].norm(), 1, 1e-5);
    }
    EXPECT_LE(2 * (coarse.size() - isolated), fine.size() - isolated);
    EXPECT_NEAR(total(coarse.areas), area, 1e-4 * area);

    // Edges: just those between the children of different nodes, with the sums of their weights.
    std::map<std::pair<Index, Index>, double> weights;
    for (Index i = 0; i < fine.size(); ++i) {
      for (Index e = fine.offsets[i]; e < fine.offsets[i + 1]; ++e) {
        const Index a = parents[i], b = parents[fine.neighbors[e]];
        if (a != b) weights[{a, b}] += fine.weight(e);
      }
    }
    ASSERT_EQ(coarse.neighbors.size(), weights.size());
    for (Index k = 0; k < coarse.size(); ++k) {
      const auto around = coarse.neighbors_of(k);
      EXPECT_TRUE(std::ranges::is_sorted(around));
      for (Index e = coarse.offsets[k]; e < coarse.offsets[k + 1]; ++e) {
        const auto it = weights.find({k, coarse.neighbors[e]});
        ASSERT_NE(it, weights.end());
        ASSERT_NEAR(coarse.weight(e), it->second, 1e-4 * it->second);
      }
    }
    EXPECT_EQ(count_components(coarse), count_components(fine));
  }
  EXPECT_TRUE(hierarchy.levels.back().neighbors.empty());
  EXPECT_EQ(hierarchy.levels.back().size(), count_components(hierarchy.levels[0]));
}

TEST(Hierarchy, CoversShapes) {
  for (const char* name : {"sphere", "bracket", "three-holes", "plate"}) {
    SCOPED_TRACE(name);
    expect_consistent(build_hierarchy(build_graph(sample_shape(name, 0.4))));
  }
  expect_consistent(build_hierarchy(made::noisy_graph()));
}

TEST(Hierarchy, CoversPointClouds) {
  Mesh cloud;
  cloud.positions = made::sphere(2000, 1).points;
  GraphOptions options;
  options.weights = GraphWeights::geometric;
  expect_consistent(build_hierarchy(build_graph(cloud, options)));
}

TEST(Hierarchy, CoversSeveralPartsAndIsolatedNodes) {
  // A path, a triangle and three nodes without neighbours.
  const Hierarchy hierarchy =
      build_hierarchy(made_graph(12, {{0, 2}, {2, 4}, {4, 6}, {6, 8}, {1, 3}, {3, 5}, {1, 5}}));
  expect_consistent(hierarchy);
  EXPECT_EQ(hierarchy.levels.back().size(), 2u + 4u);
}

/// The leaves of a star have no free neighbour once the centre is taken.
TEST(Hierarchy, MergesStars) {
  std::vector<std::array<Index, 2>> edges;
  for (Index leaf = 1; leaf <= 500; ++leaf) edges.push_back({0, leaf});
  const Hierarchy hierarchy = build_hierarchy(made_graph(501, edges));
  expect_consistent(hierarchy);
  EXPECT_EQ(hierarchy.levels.size(), 2u);
}

/// Vertices of slivers only: proposals went around in circles, and the matching never ended.
TEST(Hierarchy, NodesWithoutAreaAreMatchedLikeOthers) {
  Graph graph = build_graph(sample_shape("sphere", 0.5));
  for (Index i = 0; i < graph.size(); ++i) {
    if (hash64(i) % 2 == 0) graph.areas[i] = 0;
    const float angle = 2 * unit_float(hash64(1, i));
    graph.normals[i] = {std::cos(angle), std::sin(angle), 0};
  }
  EXPECT_EQ(build_hierarchy(graph).levels.back().size(), 1u);
}

TEST(Hierarchy, OfNothingOrOneNodeHasOneLevel) {
  EXPECT_EQ(build_hierarchy(made_graph(0, {})).levels.size(), 1u);
  EXPECT_EQ(build_hierarchy(made_graph(1, {})).levels.size(), 1u);
}

/// The paper's score: alike in area and normal first.
TEST(Hierarchy, PairsWhatIsAlike) {
  // On a path the middle edge joins equal areas; greedy by score takes it, and the ends follow.
  Graph graph = made_graph(4, {{0, 1}, {1, 2}, {2, 3}});
  graph.areas = {1, 5, 5, 1};
  const Hierarchy by_area = build_hierarchy(graph);
  EXPECT_EQ(by_area.parents[0][1], by_area.parents[0][2]);
  // Equal areas, but a crease in the middle.
  graph.areas = {1, 1, 1, 1};
  graph.normals = {Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitX()};
  const Hierarchy by_normal = build_hierarchy(graph);
  EXPECT_EQ(by_normal.parents[0][0], by_normal.parents[0][1]);
  EXPECT_EQ(by_normal.parents[0][2], by_normal.parents[0][3]);
  EXPECT_NE(by_normal.parents[0][1], by_normal.parents[0][2]);
}

TEST(Hierarchy, BlocksOfAColorDoNotTouch) {
  const Hierarchy hierarchy = build_hierarchy(build_graph(sample_shape("blob", 0.5)));
  ASSERT_EQ(hierarchy.colorings.size(), hierarchy.levels.size());
  for (std::size_t l = 0; l < hierarchy.levels.size(); ++l) {
    const Graph& graph = hierarchy.levels[l];
    const BlockColoring& coloring = hierarchy.colorings[l];
    const std::size_t size = coloring.block_size;
    std::vector<std::size_t> color((graph.size() + size - 1) / size, coloring.colors.size());
    for (std::size_t c = 0; c < coloring.colors.size(); ++c) {
      for (const Index b : coloring.colors[c]) color[b] = c;
    }
    for (Index i = 0; i < graph.size(); ++i) {
      ASSERT_LT(color[i / size], coloring.colors.size());
      for (const Index j : graph.neighbors_of(i)) {
        EXPECT_TRUE(j / size == i / size || color[j / size] != color[i / size]);
      }
    }
  }
}

TEST(Hierarchy, HasAboutLogarithmicallyManyLevels) {
  const Hierarchy hierarchy = build_hierarchy(build_graph(sample_shape("blob", 0.5)));
  const double log2 = std::log2(static_cast<double>(hierarchy.levels[0].size()));
  EXPECT_LE(static_cast<double>(hierarchy.levels.size()), log2 + 2);
  EXPECT_GT(static_cast<double>(hierarchy.levels.size()), log2 / 2);
}

}  // namespace
}  // namespace meshgrain
