#include "field/schedule.h"

#include <algorithm>

namespace meshgrain {

BlockColoring color_blocks(const Graph& graph) {
  constexpr std::size_t size = BlockColoring::block_size;
  const std::size_t blocks = (graph.size() + size - 1) / size;
  BlockColoring result;
  std::vector<Index> color(blocks, no_index);
  std::vector<Index> neighbors;
  std::vector<bool> taken;
  for (std::size_t b = 0; b < blocks; ++b) {
    neighbors.clear();
    const std::size_t end = std::min(graph.size(), (b + 1) * size);
    Index last = no_index;
    for (Index e = graph.offsets[b * size]; e < graph.offsets[end]; ++e) {
      const Index other = graph.neighbors[e] / size;
      if (other < b && other != last) neighbors.push_back(last = other);
    }
    taken.assign(result.colors.size(), false);
    for (const Index other : neighbors) taken[color[other]] = true;
    const auto free = std::find(taken.begin(), taken.end(), false) - taken.begin();
    color[b] = static_cast<Index>(free);
    if (color[b] == result.colors.size()) result.colors.emplace_back();
    result.colors[color[b]].push_back(static_cast<Index>(b));
  }
  return result;
}

}  // namespace meshgrain
