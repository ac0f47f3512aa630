#pragma once

#include "field/relax_positions.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// Orientations of the nodes [begin, end) of a level from those of their parents: projected, unit.
void prolong_orientations(const Graph& graph, const std::vector<Index>& parents, Index begin,
                          Index end, const Vec3* coarser, Vec3* values);

/// Orientations of the nodes [begin, end) of a level (`coarse`) from those of their children: means
/// weighted by area, a child at a time in its most similar rotation.
void restrict_orientations(const Graph& fine, const Graph& coarse, const Children& children,
                           int rosy, Index begin, Index end, const Vec3* finer, Vec3* values);

/// Points of the nodes [begin, end) of a level from those of their parents: projected, and of their
/// lattice the nearest to the node.
void prolong_positions(const Graph& graph, const LatticeFrame& frame,
                       const std::vector<Index>& parents, int posy, Index begin, Index end,
                       const Vec3* coarser, Vec3* values);

}  // namespace meshgrain
