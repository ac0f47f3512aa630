#pragma once

#include <array>
#include <vector>

#include "field/jumps.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Calls `body(entry, jump)` for each edge of the graph between nodes i < j with `wanted(i, j)`, in
/// parallel: `entry` is the place of j among the neighbours of i (Graph::neighbors), and the jump
/// leads from i to j.
template <typename Wanted, typename Body>
void for_entry_jumps(const Graph& graph, const OrientationField& orientation,
                     const PositionField& position, PositionEnergy energy, const Wanted& wanted,
                     const Body& body, const Context& context) {
  context.for_ranges(graph.size(), 2048, [&](std::size_t begin, std::size_t end) {
    std::vector<std::array<Index, 2>> edges;
    std::vector<Index> entries;  // of each edge
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
        const Index j = graph.neighbors[e];
        if (j < i || !wanted(i, j)) continue;
        edges.push_back({i, j});
        entries.push_back(e);
      }
    }
    const std::vector<Jump> jumps = edge_jumps(graph, orientation, position, energy, edges);
    for (std::size_t k = 0; k < jumps.size(); ++k) body(entries[k], jumps[k]);
  });
}

}  // namespace meshgrain
