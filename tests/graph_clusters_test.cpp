#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include "extract/contested_cluster.h"
#include "mesh/duplicates.h"
#include "util/hash.h"
#include "util/indices.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

std::vector<std::array<Index, 2>> made_edges(Index nodes, std::size_t count, std::uint64_t seed) {
  std::vector<std::array<Index, 2>> edges;
  for (std::uint64_t e = 0; e < count; ++e) {
    edges.push_back({static_cast<Index>(hash64(seed, 2 * e) % nodes),
                     static_cast<Index>(hash64(seed, 2 * e + 1) % nodes)});
  }
  return edges;
}

TEST(SharedUnionFind, HasTheSetsOfOneThreadWithTheLowestAsRoot) {
  constexpr Index nodes = 100000;
  for (const std::size_t count : {1000u, 50000u, 80000u, 400000u}) {
    const auto edges = made_edges(nodes, count, count);
    UnionFind expected(nodes);
    for (const auto& [a, b] : edges) expected.unite(a, b);
    SharedUnionFind sets(nodes);
    const Context context(3);
    for_indices(
        edges.size(), [&](Index e) { sets.unite(edges[e][0], edges[e][1]); }, context);
    for (Index i = 0; i < nodes; ++i) ASSERT_EQ(sets.find(i), expected.find(i));
  }
}

TEST(DistinctPositions, AreTheFirstOfTheirPlace) {
  std::vector<Vec3> points;
  for (std::uint64_t i = 0; i < 60000; ++i) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = static_cast<float>(hash64(i, static_cast<std::uint64_t>(axis)) % 30) - 15.0f;
    }
    points.push_back(i % 2 ? p : Vec3(-1.0f * p));  // with some -0
  }
  std::map<std::tuple<float, float, float>, Index> seen;
  std::vector<Index> expected, expected_place;
  for (Index i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const auto [it, is_new] =
        seen.try_emplace({p[0], p[1], p[2]}, static_cast<Index>(expected.size()));
    if (is_new) expected.push_back(i);
    expected_place.push_back(it->second);
  }
  for (const int threads : {1, 3}) {
    std::vector<Index> place;
    EXPECT_EQ(distinct_positions(points, &place, Context(threads)), expected);
    EXPECT_EQ(place, expected_place);
  }
}

/// A cluster among other nodes, with links by chance.
struct MadeCluster {
  Graph graph;
  std::vector<Link> links;
  std::vector<Vec3> points;
  std::vector<Index> members;  // every third node

  MadeCluster(Index count, std::size_t edges, std::uint64_t seed) {
    std::set<std::array<Index, 2>> both_ways;
    for (const auto& [a, b] : made_edges(3 * count, edges, seed)) {
      if (a == b) continue;
      both_ways.insert({a, b});
      both_ways.insert({b, a});
    }
    graph.offsets.assign(3 * count + 1, 0);
    for (const auto& [a, b] : both_ways) {
      ++graph.offsets[a + 1];
      graph.neighbors.push_back(b);
      const std::uint64_t roll = hash64(seed, a + 1000000 * b) % 10;
      // To lower nodes all are alike, as these shall not count.
      links.push_back(a > b      ? Link::unit
                      : roll < 6 ? Link::zero
                      : roll < 7 ? Link::unit
                                 : Link::other);
    }
    std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
    for (Index i = 0; i < 3 * count; ++i) {
      // On whole numbers, so that distances are often equal.
      points.push_back({static_cast<float>(hash64(seed, i) % 4), 0, 0});
      if (i % 3 == 1) members.push_back(i);
    }
  }

  /// Those between members, as the rule reads.
  std::vector<std::array<Index, 2>> between_members(Link link) const {
    std::vector<std::array<Index, 2>> result;
    for (const Index i : members) {
      for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
        const Index j = graph.neighbors[e];
        if (j > i && j % 3 == 1 && links[e] == link) result.push_back({i, j});
      }
    }
    return result;
  }
};

TEST(PartContestedCluster, UnitesTheNearestFirstUnlessAUnitLinkForbids) {
  std::size_t parts = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const MadeCluster made(40, 900, seed);
    // Labels of all members, changed one by one.
    std::map<Index, Index> label;
    for (const Index i : made.members) label[i] = i;
    auto zeros = made.between_members(Link::zero);
    std::ranges::stable_sort(zeros, {}, [&](const auto& edge) {
      return (made.points[edge[0]] - made.points[edge[1]]).norm();
    });
    const auto units = made.between_members(Link::unit);
    for (const auto& [i, j] : zeros) {
      const Index a = std::min(label[i], label[j]), b = std::max(label[i], label[j]);
      const bool is_forbidden = std::ranges::any_of(units, [&](const auto& unit) {
        return std::minmax(label[unit[0]], label[unit[1]]) == std::minmax(a, b);
      });
      if (is_forbidden) continue;
      for (auto& [node, own] : label) own = own == b ? a : own;
    }
    std::vector<Index> expected;
    for (const Index i : made.members) expected.push_back(label[i]);
    EXPECT_EQ(part_contested_cluster(made.graph, made.links, made.points, made.members), expected);
    for (const auto& [i, j] : units) EXPECT_NE(label[i], label[j]);
    parts += std::set<Index>(expected.begin(), expected.end()).size();
  }
  // Neither all alone nor all together.
  EXPECT_GT(parts, 50u * 2);
  EXPECT_LT(parts, 50u * 30);
}

}  // namespace
}  // namespace meshgrain
