#pragma once

#include "features/feature_edges.h"
#include "field/jumps.h"

namespace meshgrain {

/// The integer jumps of a position field, with those that feature lines decide.
class FeatureJumps {
 public:
  FeatureJumps(const Graph& graph, const OrientationField& orientation,
               const PositionField& position, PositionEnergy energy)
      : graph_(graph), orientation_(orientation), position_(position), energy_(energy) {}

  /// The jump from node i to node j. Between two nodes of an `aligned` line it runs along an axis.
  /// The lattice of a corner is not its own: the lines that meet there each bring theirs, and its
  /// neighbours say where it lies.
  Jump jump(Index i, Index j, Hold hold_i, Hold hold_j, bool aligned) const;

 private:
  Jump into_corner(Index i, Index corner) const;

  const Graph& graph_;
  const OrientationField& orientation_;
  const PositionField& position_;
  PositionEnergy energy_;
};

/// Whether a jump runs along an axis of the lattice.
bool is_along_axis(const std::array<int, 2>& t, int posy);

}  // namespace meshgrain
