#pragma once

#include <array>
#include <vector>

#include "meshgrain/extract.h"

namespace meshgrain {

/// The graph G' of section 3.8 after its collapse: one cluster of input nodes an output vertex.
struct Clusters {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Index> nodes;                  // the member nearest to the position
  std::vector<std::array<Index, 2>> edges;   // sorted, first < second
  std::vector<std::array<Index, 2>> border;  // those of the edges that lie on the border, sorted
  std::vector<std::uint8_t> on_border;       // whether a cluster has nodes on the border
};

Clusters collapse_clusters(const Graph& graph, const OrientationField& orientation,
                           const PositionField& position, const ExtractOptions& options,
                           const Context& context);

}  // namespace meshgrain
