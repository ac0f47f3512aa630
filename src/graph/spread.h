#pragma once

#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// Dijkstra's algorithm from many nodes at once: lowers `values` over a graph as far as the values
/// of `sources`, with their nodes, reach. `lower(i, j)` lowers the value of j by what that of its
/// neighbour i allows, and returns whether it did.
template <typename Lower>
void spread(const Graph& graph, const std::vector<float>& values,
            std::vector<std::pair<float, Index>> sources, const Lower& lower,
            const Context& context) {
  using Entry = std::pair<float, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(std::greater<>(),
                                                                       std::move(sources));
  std::size_t done = 0;
  while (!queue.empty()) {
    const auto [value, i] = queue.top();
    queue.pop();
    if (value > values[i]) continue;
    if ((++done & 0xffff) == 0) context.check();
    for (const Index j : graph.neighbors_of(i)) {
      if (lower(i, j)) queue.push({values[j], j});
    }
  }
}

}  // namespace meshgrain
