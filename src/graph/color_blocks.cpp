#include "graph/color_blocks.h"

#include <algorithm>
#include <bit>

namespace meshgrain {
namespace {

/// Nodes a block. Long blocks have fewer neighbours, and lie close together in memory. But each of
/// the colours, about seven, must have as many of them as there are SIMD lanes.
std::size_t block_size(std::size_t nodes) {
  constexpr std::size_t least_blocks = 96;
  return std::clamp(std::bit_floor(nodes / least_blocks), std::size_t{1}, BlockColoring::longest);
}

/// The blocks before each block that have neighbours in it.
struct LowerBlocks {
  std::vector<std::size_t> ends;  // of each block's, one after the other
  std::vector<Index> blocks;
};

LowerBlocks lower_blocks(const Graph& graph, std::size_t size, std::size_t begin, std::size_t end) {
  const auto first_entry = [&](std::size_t b) {
    return graph.offsets[std::min(graph.size(), b * size)];
  };
  LowerBlocks result;
  // Room for all, so that none needs a branch, which would be foretold badly.
  result.blocks.resize(first_entry(end) - first_entry(begin) + 1);
  std::size_t count = 0;
  for (std::size_t b = begin; b < end; ++b) {
    Index last = no_index;
    for (Index e = first_entry(b); e < first_entry(b + 1); ++e) {
      const Index other = graph.neighbors[e] / static_cast<Index>(size);
      const bool is_lower = other < b;
      result.blocks[count] = other;
      count += is_lower && other != last;
      last = is_lower ? other : last;
    }
    result.ends.push_back(count);
  }
  result.blocks.resize(count);
  result.blocks.shrink_to_fit();
  return result;
}

}  // namespace

BlockColoring color_blocks(const Graph& graph, const Context& context) {
  constexpr std::size_t grain = 128;
  const std::size_t size = block_size(graph.size());
  const std::size_t blocks = (graph.size() + size - 1) / size;
  std::vector<LowerBlocks> ranges((blocks + grain - 1) / grain);
  context.for_ranges(blocks, grain, [&](std::size_t begin, std::size_t end) {
    ranges[begin / grain] = lower_blocks(graph, size, begin, end);
  });
  BlockColoring result;
  result.block_size = size;
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
