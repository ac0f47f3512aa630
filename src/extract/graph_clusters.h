#pragma once

#include "extract/clusters.h"

namespace meshgrain {

/// The graph G' of section 3.8 after its collapse: clusters of nodes that share a lattice point,
/// and the unit edges between them.
struct CollapsedGraph {
  Clusters clusters;
  std::vector<std::array<Index, 2>> edges;   // between clusters; sorted, first < second
  std::vector<std::array<Index, 2>> border;  // those of the edges that lie on the border, sorted
};

/// The graph way, for point clouds and everything else: no mesh is needed.
CollapsedGraph collapse_graph(const Graph& graph, const OrientationField& orientation,
                              const PositionField& position, const ExtractOptions& options,
                              const Context& context);

}  // namespace meshgrain
