#pragma once

#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Principal curvatures and directions, one a node; curvatures are positive where the surface bends
/// away from its normal (a sphere of radius r with outward normals has 1/r) and in units of one
/// over the unit of the positions.
struct Curvature {
  std::vector<Vec3> direction;  ///< Unit and tangent: along which kmax is taken.
  std::vector<float> kmax;      ///< The principal curvature of largest absolute value.
  std::vector<float> kmin;      ///< The other one, across `direction`.
};

/// Fits the second fundamental form at each node of a neighbour graph to the differences of the
/// normals along its edges, by least squares (as Rusinkiewicz 2004 does for each triangle). The
/// neighbours of node i are `neighbors[offsets[i]]` up to `neighbors[offsets[i + 1]]`; `normals`
/// are unit vectors. Each of `smoothing` rounds then averages the forms of neighbours, for noisy
/// input. A node with too few neighbours to tell has no curvature and any tangent direction.
Curvature estimate_curvature(std::span<const Index> offsets, std::span<const Index> neighbors,
                             std::span<const Vec3> positions, std::span<const Vec3> normals,
                             const Context& context = Context(), int smoothing = 0);

}  // namespace meshgrain
