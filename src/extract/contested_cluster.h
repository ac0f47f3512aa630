#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshgrain/graph.h"

namespace meshgrain {

/// What the jump along an edge of the graph makes of it (section 3.8): nothing, one vertex of its
/// two nodes, or an edge of the output.
enum class Link : std::uint8_t { other, zero, unit };

/// Parts a cluster that zero jumps join though unit jumps forbid it: the links with zero jump unite
/// nodes, those with the nearest lattice points first, unless a unit link joins the two sets.
/// `links` has one for each of Graph::neighbors, of which those to higher nodes count; `points` are
/// the lattice points of all nodes, `members` the cluster, increasing. Returns for each member the
/// first one of its part.
std::vector<Index> part_contested_cluster(const Graph& graph, std::span<const Link> links,
                                          std::span<const Vec3> points,
                                          std::span<const Index> members);

}  // namespace meshgrain
