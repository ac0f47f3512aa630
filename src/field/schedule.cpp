#include "field/schedule.h"

#include <algorithm>

namespace meshgrain {
namespace {

/// The blocks before each block that have neighbours in it.
struct LowerBlocks {
  std::vector<std::size_t> ends;  // of each block's, one after the other
  std::vector<Index> blocks;
};

LowerBlocks lower_blocks(const Graph& graph, std::size_t begin, std::size_t end) {
  constexpr std::size_t size = BlockColoring::block_size;
  LowerBlocks result;
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t nodes_end = std::min(graph.size(), (b + 1) * size);
    Index last = no_index;
    for (Index e = graph.offsets[b * size]; e < graph.offsets[nodes_end]; ++e) {
      const Index other = graph.neighbors[e] / size;
      if (other < b && other != last) result.blocks.push_back(last = other);
    }
    result.ends.push_back(result.blocks.size());
  }
  return result;
}

}  // namespace

BlockColoring color_blocks(const Graph& graph, const Context& context) {
  constexpr std::size_t size = BlockColoring::block_size, grain = 128;
  const std::size_t blocks = (graph.size() + size - 1) / size;
  std::vector<LowerBlocks> ranges((blocks + grain - 1) / grain);
  context.for_ranges(blocks, grain, [&](std::size_t begin, std::size_t end) {
    ranges[begin / grain] = lower_blocks(graph, begin, end);
  });
  BlockColoring result;
  std::vector<Index> color;
  std::vector<bool> taken;
  for (const LowerBlocks& range : ranges) {
    std::size_t k = 0;
    for (const std::size_t end : range.ends) {
      taken.assign(result.colors.size(), false);
      for (; k < end; ++k) taken[color[range.blocks[k]]] = true;
      const auto free = std::find(taken.begin(), taken.end(), false) - taken.begin();
      if (static_cast<std::size_t>(free) == result.colors.size()) result.colors.emplace_back();
      result.colors[static_cast<std::size_t>(free)].push_back(static_cast<Index>(color.size()));
      color.push_back(static_cast<Index>(free));
    }
  }
  return result;
}

}  // namespace meshgrain
