#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/error.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// Fills offsets and neighbours from `neighbors_of(i, out)`, which appends the neighbours of node i
/// in increasing order.
template <typename NeighborsOf>
void gather_neighbors(Graph& graph, const NeighborsOf& neighbors_of, const Context& context) {
  constexpr std::size_t grain = 4096;
  const std::size_t n = graph.size();
  graph.offsets.assign(n + 1, 0);
  std::vector<std::vector<Index>> gathered((n + grain - 1) / grain);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    auto& out = gathered[begin / grain];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t start = out.size();
      neighbors_of(static_cast<Index>(i), out);
      graph.offsets[i + 1] = static_cast<Index>(out.size() - start);
    }
  });
  // SIMD lanes count entries with a sign.
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  std::size_t entries = 0;
  for (std::size_t i = 0; i < n; ++i) {
    entries += graph.offsets[i + 1];
    if (entries > most) {
      throw Error("too large: the points have more than 2147483647 neighbours in all");
    }
    graph.offsets[i + 1] = static_cast<Index>(entries);
  }
  graph.neighbors.resize(graph.offsets[n]);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t) {
    auto& range = gathered[begin / grain];
    std::ranges::copy(range, graph.neighbors.begin() + graph.offsets[begin]);
    range = {};
  });
}

}  // namespace meshgrain
