#pragma once

#include <span>
#include <vector>

#include "features/feature_edges.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// What input nodes become after the collapse of section 3.8: one cluster an output vertex.
struct Clusters {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<float> cover;             // area, in units of a lattice cell as large as the mean
  std::vector<Index> nodes;             // the member nearest to the position
  std::vector<std::uint8_t> on_border;  // whether a cluster has nodes on the border
  std::vector<std::uint8_t> hold;       // how each is held (Hold); for whoever has features

  /// Another one in the middle of some, which nothing holds.
  void append_mean(std::span<const Index> some);
  /// Drops all but some, which are increasing.
  void keep(std::span<const Index> kept);
};

/// Positions, normals and nearest nodes of `count` clusters (section 3.8). Member m is node
/// `nodes[m]` and belongs to cluster `cluster_of[m]` (or to none: no_index). `border` and `hold`
/// are of each node. The nearest node of a cluster is one of those that are held most.
Clusters average_clusters(const Graph& graph, const PositionField& position,
                          std::span<const Index> nodes, std::span<const Index> cluster_of,
                          std::span<const std::uint8_t> border, std::span<const std::uint8_t> hold,
                          std::size_t count, const Context& context);

}  // namespace meshgrain
