#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "field/jumps.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The vertices of a surface that share a lattice point, as far as they can become one all at once:
/// connected sets whose inner edges have zero jump, that are disks, and without which the surface
/// is still a triangle mesh of the same topology. All other vertices stay alone.
struct DiskClusters {
  std::vector<Index> root;             // of each vertex: the middle one of its cluster
  std::vector<std::uint8_t> rotation;  // of each vertex: from the frame of its root to its own
  std::vector<std::array<Index, 3>> triangles;  // of the surface: those between three clusters
  int posy = 4;

  /// What the jump of an edge of the surface is between the roots.
  Jump between_roots(Index i, Index j, const Jump& jump) const;
};

/// `is_free`: of each vertex of the surface, whether it may be in a cluster; those on a border or
/// where the surface is not manifold stay alone anyway.
DiskClusters find_disk_clusters(const Mesh& surface, const Graph& graph,
                                const OrientationField& orientation, const PositionField& position,
                                PositionEnergy energy, std::vector<std::uint8_t> is_free,
                                const Context& context);

}  // namespace meshgrain
