#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/graph.h"
#include "util/bucket_queue.h"

namespace meshgrain {

/// Shortest paths from many nodes at once: lowers `values` over a graph as far as the values of
/// `sources`, with their nodes, reach. `lower(i, j)` lowers the value of j by what that of its
/// neighbour i allows, and returns whether it did. `slope`: about how fast values grow with the
/// distance.
template <typename Lower>
void spread(const Graph& graph, const std::vector<float>& values,
            const std::vector<std::pair<float, Index>>& sources, float slope, const Lower& lower,
            const Context& context) {
  const double area = std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0);
  const double spacing =
      std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, graph.size())));
  BucketQueue queue(std::max(slope * static_cast<float>(spacing) / 2, 1e-30f));
  for (const auto& [value, i] : sources) queue.push(value, i);
  std::size_t done = 0;
  while (queue.find()) {
    const auto [value, i] = queue.pop();
    if (value > values[i]) continue;
    if ((++done & 0xffff) == 0) context.check();
    for (const Index j : graph.neighbors_of(i)) {
      if (lower(i, j)) queue.push(values[j], j);
    }
  }
}

}  // namespace meshgrain
