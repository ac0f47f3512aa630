#include "meshgrain/hierarchy.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "graph/color_blocks.h"
#include "graph/match_pairs.h"
#include "graph/merge_edges.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 2048;

/// Groups of nodes that become one: pairs with those that follow one of the two, of which there are
/// few, or single nodes without neighbours.
class Groups {
 public:
  Groups(const std::vector<Index>& partner, const Context& context)
      : partner_(partner),
        first_follower_(partner.size(), no_index),
        next_follower_(std::make_unique_for_overwrite<Index[]>(partner.size())) {
    const std::vector<Index> followers = indices_where(
        partner.size(), [&](Index i) { return is_follower(i); }, context);
    for (std::size_t k = followers.size(); k-- > 0;) {
      const Index i = followers[k];
      next_follower_[i] = std::exchange(first_follower_[leader(i)], i);
    }
  }

  std::size_t nodes() const { return partner_.size(); }

  /// Whether i is the first node of its group.
  bool is_first(Index i) const {
    const Index l = leader(i), follower = first_follower_[l];
    return i == std::min(l, follower);
  }

  /// Calls `body` for the nodes of i's group in increasing order.
  template <typename Body>
  void for_nodes(Index i, const Body& body) const {
    const Index pair[] = {leader(i),
                          partner_[leader(i)]};  // the same, of a node without neighbours
    Index follower = first_follower_[pair[0]];
    const auto followers_before = [&](Index end) {
      for (; follower < end; follower = next_follower_[follower]) body(follower);
    };
    followers_before(pair[0]);
    body(pair[0]);
    if (pair[1] != pair[0]) {
      followers_before(pair[1]);
      body(pair[1]);
    }
    followers_before(no_index);
  }

 private:
  bool is_follower(Index i) const { return partner_[partner_[i]] != i; }

  /// The lower node of the pair.
  Index leader(Index i) const {
    const Index j = partner_[i];
    return std::min(is_follower(i) ? partner_[j] : i, j);
  }

  const std::vector<Index>& partner_;
  std::vector<Index> first_follower_;  // of each leader
  std::unique_ptr<Index[]> next_follower_;
};

/// The nodes of the coarser level.
Children number(const Groups& groups, std::vector<Index>& parents, const Context& context) {
  const std::size_t n = groups.nodes();
  struct Range {
    std::vector<Index> firsts;  // of the groups that start in it
    Index groups_before = 0, nodes_before = 0;
  };
  std::vector<Range> ranges((n + grain - 1) / grain + 1);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Index>& firsts = ranges[begin / grain].firsts;
    firsts.resize(end - begin);
    std::size_t count = 0;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      firsts[count] = i;
      count += groups.is_first(i);
    }
    firsts.resize(count);
    Index& nodes = ranges[begin / grain + 1].nodes_before;
    for (const Index first : firsts) groups.for_nodes(first, [&](Index) { ++nodes; });
  });
  for (std::size_t r = 1; r < ranges.size(); ++r) {
    ranges[r].nodes_before += ranges[r - 1].nodes_before;
    ranges[r].groups_before =
        ranges[r - 1].groups_before + static_cast<Index>(ranges[r - 1].firsts.size());
  }
  Children result;
  result.offsets.resize(ranges.back().groups_before + 1);
  result.offsets.back() = ranges.back().nodes_before;
  result.nodes.resize(n);
  parents.resize(n);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t) {
    const Range& range = ranges[begin / grain];
    Index k = range.groups_before, place = range.nodes_before;
    for (const Index first : range.firsts) {
      result.offsets[k] = place;
      groups.for_nodes(first, [&](Index child) {
        parents[child] = k;
        result.nodes[place++] = child;
      });
      ++k;
    }
  });
  return result;
}

void merge_nodes(const Graph& fine, const Children& children, Graph& coarse,
                 const Context& context) {
  const std::size_t n = children.size();
  coarse.positions.resize(n);
  coarse.normals.resize(n);
  coarse.areas.resize(n);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
      float area = 0, total = 0;
      for (const Index i : children[k]) {
        const float weight = std::max(fine.areas[i], 1e-30f);
        position += weight * fine.positions[i];
        normal += weight * fine.normals[i];
        area += fine.areas[i];
        total += weight;
      }
      coarse.areas[k] = area;
      coarse.positions[k] = position / total;
      const float length = normal.norm();
      coarse.normals[k] =
          length > 1e-6f * total ? Vec3(normal / length) : fine.normals[children[k][0]];
    }
  });
}

}  // namespace

Hierarchy build_hierarchy(Graph graph, const Context& context) {
  Hierarchy hierarchy;
  const std::size_t finest = graph.size();
  hierarchy.levels.push_back(std::move(graph));
  while (!hierarchy.levels.back().neighbors.empty()) {
    const Graph& fine = hierarchy.levels.back();
    const std::vector<Index> partner = match_pairs(fine, context);
    std::vector<Index> parents;
    Children children = number(Groups(partner, context), parents, context);
    Graph coarse;
    merge_nodes(fine, children, coarse, context);
    merge_edges(fine, parents, children, coarse, context);
    hierarchy.parents.push_back(std::move(parents));
    hierarchy.children.push_back(std::move(children));
    hierarchy.levels.push_back(std::move(coarse));
    context.progress("hierarchy", 1.0 - static_cast<double>(hierarchy.levels.back().size()) /
                                            static_cast<double>(finest));
  }
  for (const Graph& level : hierarchy.levels) {
    hierarchy.colorings.push_back(color_blocks(level, context));
  }
  return hierarchy;
}

}  // namespace meshgrain
