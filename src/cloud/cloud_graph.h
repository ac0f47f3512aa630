#pragma once

#include "cloud/nearest_neighbors.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// build_graph() of a point cloud whose nearest neighbours are known.
Graph cloud_graph(const Mesh& cloud, const Neighborhoods& nearest, const GraphOptions& options,
                  const Context& context);

}  // namespace meshgrain
