#include "graph/merge_edges.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "graph/merge_edges.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "util/dispatch.h"
#ifndef MESHGRAIN_GRAPH_MERGED_ROWS
#define MESHGRAIN_GRAPH_MERGED_ROWS
namespace meshgrain {

/// The edges of a range of coarse nodes, one node after the other.
struct MergedRows {
  std::unique_ptr<Index[]> neighbors;
  std::unique_ptr<float[]> weights;
  std::size_t size = 0;
};

}  // namespace meshgrain
#endif

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t most_lanes = 16;
using Lanes = hn::CappedTag<std::int32_t, most_lanes>;

/// Edges of a node as they come from its children, some of them several times.
class Entries {
 public:
  explicit Entries(std::size_t most)
      : nodes_(std::max(most, few) + most_lanes), weights_(nodes_.size()) {}

  void clear() { size_ = 0; }
  void add_unless(bool left_out, Index node, float weight) {
    nodes_[size_] = static_cast<std::int32_t>(node);
    weights_[size_] = weight;
    size_ += !left_out;
  }

  /// Each once, in increasing order, with the sum of its weights; returns how many these are.
  std::size_t merge(Index* nodes, float* weights) {
    return size_ <= few ? merge_few(nodes, weights) : merge_many(nodes, weights);
  }

 private:
  static constexpr std::size_t few = 48;

  /// To the place that says how many others are less: the same one for the same node. Sorting
  /// would branch on the order, which no processor foretells.
  std::size_t merge_few(Index* nodes, float* weights) {
    const Lanes d;
    hn::StoreU(hn::Set(d, std::numeric_limits<std::int32_t>::max()), d, nodes_.data() + size_);
    std::array<std::int32_t, few> sorted;
    std::array<float, few> sums;
    for (std::size_t k = 0; k < size_; ++k) {
      sorted[k] = -1;
      sums[k] = 0;
    }
    for (std::size_t k = 0; k < size_; ++k) {
      const std::int32_t node = nodes_[k];
      std::size_t less = 0;
      for (std::size_t l = 0; l < size_; l += hn::Lanes(d)) {
        less += hn::CountTrue(d, hn::Lt(hn::LoadU(d, nodes_.data() + l), hn::Set(d, node)));
      }
      sorted[less] = node;
      sums[less] += weights_[k];
    }
    std::size_t count = 0;
    for (std::size_t k = 0; k < size_; ++k) {
      nodes[count] = static_cast<Index>(sorted[k]);
      weights[count] = sums[k];
      count += sorted[k] >= 0;
    }
    return count;
  }

  std::size_t merge_many(Index* nodes, float* weights) {
    std::vector<std::size_t> order(size_);
    for (std::size_t k = 0; k < size_; ++k) order[k] = k;
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return nodes_[k]; });
    std::size_t count = 0;
    for (const std::size_t k : order) {
      const auto node = static_cast<Index>(nodes_[k]);
      if (count == 0 || nodes[count - 1] != node) {
        nodes[count] = node;
        weights[count++] = 0;
      }
      weights[count - 1] += weights_[k];
    }
    return count;
  }

  std::size_t size_ = 0;
  std::vector<std::int32_t> nodes_;
  std::vector<float> weights_;
};

/// The edges of the nodes in [begin, end); `degrees` gets how many each has.
MergedRows merge_rows(const Graph& fine, const std::vector<Index>& parents,
                      const Children& children, std::size_t begin, std::size_t end,
                      Index* degrees) {
  std::size_t all = 0, most = 0;
  for (std::size_t k = begin; k < end; ++k) {
    std::size_t count = 0;
    for (const Index child : children[k]) count += fine.neighbors_of(child).size();
    all += count;
    most = std::max(most, count);
  }
  MergedRows rows;
  rows.neighbors = std::make_unique_for_overwrite<Index[]>(all);
  rows.weights = std::make_unique_for_overwrite<float[]>(all);
  Entries entries(most);
  for (std::size_t k = begin; k < end; ++k) {
    entries.clear();
    for (const Index child : children[k]) {
      for (Index e = fine.offsets[child]; e < fine.offsets[child + 1]; ++e) {
        const Index node = parents[fine.neighbors[e]];
        entries.add_unless(node == k, node, fine.weight(e));
      }
    }
    const std::size_t count =
        entries.merge(rows.neighbors.get() + rows.size, rows.weights.get() + rows.size);
    rows.size += count;
    degrees[k - begin] = static_cast<Index>(count);
  }
  return rows;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

void merge_edges(const Graph& fine, const std::vector<Index>& parents, const Children& children,
                 Graph& coarse, const Context& context) {
  constexpr std::size_t grain = 2048;
  const std::size_t n = children.size();
  coarse.offsets.assign(n + 1, 0);
  std::vector<MergedRows> parts((n + grain - 1) / grain);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    parts[begin / grain] = MESHGRAIN_BEST_TARGET(merge_rows)(fine, parents, children, begin, end,
                                                             coarse.offsets.data() + begin + 1);
  });
  for (std::size_t k = 0; k < n; ++k) coarse.offsets[k + 1] += coarse.offsets[k];
  coarse.neighbors.resize(coarse.offsets[n]);
  coarse.weights.resize(coarse.offsets[n]);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t) {
    MergedRows& part = parts[begin / grain];
    const std::size_t first = coarse.offsets[begin];
    std::copy_n(part.neighbors.get(), part.size, coarse.neighbors.data() + first);
    std::copy_n(part.weights.get(), part.size, coarse.weights.data() + first);
    part = {};
  });
}

}  // namespace meshgrain
#endif
