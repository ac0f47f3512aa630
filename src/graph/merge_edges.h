#pragma once

#include "meshgrain/hierarchy.h"

namespace meshgrain {

/// Gives the nodes of a coarser level their edges: those between children of different nodes, with
/// the sums of their weights.
void merge_edges(const Graph& fine, const std::vector<Index>& parents, const Children& children,
                 Graph& coarse, const Context& context);

}  // namespace meshgrain
