#pragma once

#include <vector>

#include "meshgrain/graph.h"

namespace meshgrain {

/// For each node the neighbour that it is merged with, by the score of section 3.5, the best pairs
/// first; a node without neighbours has itself. Where all neighbours are in pairs already, a node
/// follows one of them and makes it three: left alone, such nodes would pile up around their larger
/// neighbours, which always prefer each other, and the levels would hardly shrink any more.
std::vector<Index> match_pairs(const Graph& graph, const Context& context);

}  // namespace meshgrain
