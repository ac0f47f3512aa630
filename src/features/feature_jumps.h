#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "features/feature_edges.h"
#include "field/jumps.h"

namespace meshgrain {

/// The integer jumps of a position field, with those that feature lines decide.
class FeatureJumps {
 public:
  /// `hold`: of each node, a Hold. All must outlive this.
  FeatureJumps(const Graph& graph, const OrientationField& orientation,
               const PositionField& position, PositionEnergy energy,
               std::span<const std::uint8_t> hold)
      : graph_(graph),
        orientation_(orientation),
        position_(position),
        energy_(energy),
        hold_(hold) {}

  /// The jumps of directed edges. The lattice of a corner is not its own: the lines that meet there
  /// each bring theirs, and its neighbours say where it lies.
  std::vector<Jump> jumps(std::span<const std::array<Index, 2>> edges) const;

  /// What becomes of the jump of an edge of an aligned line: it runs along an axis.
  Jump aligned(const std::array<Index, 2>& edge, const Jump& jump) const;

 private:
  /// Whether the jump is to be found from the other end, as this one is a corner.
  bool starts_at_corner(const std::array<Index, 2>& edge) const {
    return hold_[edge[0]] == at_corner && hold_[edge[1]] != at_corner;
  }
  Jump into_corner(Index i, Index corner) const;

  const Graph& graph_;
  const OrientationField& orientation_;
  const PositionField& position_;
  PositionEnergy energy_;
  std::span<const std::uint8_t> hold_;
};

/// Whether a jump runs along an axis of the lattice.
bool is_along_axis(const std::array<int, 2>& t, int posy);

}  // namespace meshgrain
