#pragma once

#include <cstddef>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// The area of each piece of a graph that hangs together.
std::vector<double> piece_areas(const Graph& graph, const Context& context);

/// Which share of so many faces holes, handles and pieces take in a lattice of which every cell
/// becomes four, if all are too small for it: from the Euler number of the triangles whose vertices
/// and edges are those of the graph.
double share_of_holes(const Graph& graph, std::size_t triangles, double faces,
                      const Context& context);

}  // namespace meshgrain
