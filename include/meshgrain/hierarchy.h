#pragma once

#include <span>
#include <vector>

#include "meshgrain/graph.h"

namespace meshgrain {

/// The nodes of one level, each with those of the next finer one that were merged into it, in
/// increasing order. Numbered by their first children, which keeps the order along the curve.
struct Children {
  std::vector<Index> offsets;  ///< nodes + 1: where each one's children start.
  std::vector<Index> nodes;

  std::size_t size() const { return offsets.empty() ? 0 : offsets.size() - 1; }
  std::span<const Index> operator[](std::size_t k) const {
    return {nodes.data() + offsets[k], offsets[k + 1] - offsets[k]};
  }
};

/// Nodes in blocks of consecutive indices, the blocks in groups ("colours") such that no two of a
/// group are neighbours. Blocks of a group can be swept at once, each in the order of its nodes, by
/// different threads or in different SIMD lanes: the result is the same for any number of either.
struct BlockColoring {
  static constexpr std::size_t longest = 64;
  std::size_t block_size = longest;        ///< Nodes a block, but for the last.
  std::vector<std::vector<Index>> colors;  ///< The blocks of each colour.
};

/// Coarser and coarser graphs by merging pairs of neighbours (section 3.5). Level 0 is the input;
/// the last has one node a connected component.
struct Hierarchy {
  std::vector<Graph> levels;
  /// parents[l][i]: the node of level l + 1 that node i of level l was merged into.
  std::vector<std::vector<Index>> parents;
  /// children[l][k]: the nodes of level l that became node k of level l + 1.
  std::vector<Children> children;
  std::vector<BlockColoring> colorings;  ///< Of each level.
};

/// Pairs are taken by the paper's score <n_i, n_j> min(A_i / A_j, A_j / A_i), the best first, by
/// rounds of mutual proposals: the same pairs as one global sort would give, without the sort.
/// Nodes whose neighbours are all taken join one of them, so that each level has at most half of
/// the nodes of the one before (but for nodes without neighbours).
Hierarchy build_hierarchy(Graph graph, const Context& context = Context());

}  // namespace meshgrain
