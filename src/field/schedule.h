#pragma once

#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// Nodes in blocks of consecutive indices, the blocks in groups ("colours") such that no two of a
/// group are neighbours. Blocks of a group can be swept at once, each in the order of its nodes,
/// by different threads or in different SIMD lanes: the result is the same for any number of
/// either.
struct BlockColoring {
  static constexpr std::size_t block_size = 64;
  std::vector<std::vector<Index>> colors;  // the blocks of each colour
};

BlockColoring color_blocks(const Graph& graph, const Context& context);

}  // namespace meshgrain
