#pragma once

#include <span>

#include "meshgrain/fields.h"

namespace meshgrain {

/// Constraints of one level, dense: strength 0 where there is none. Empty if the level has none.
struct LineConstraints {
  std::vector<Vec3> points;
  std::vector<Vec3> directions;  // zero: the point itself
  std::vector<float> strengths;
};

/// What a position field on one level is made over.
struct LatticeFrame {
  std::vector<Vec3> directions;
  EdgeLength edge_length;
};

/// Eq. 7 for several nodes at once: running weighted mean of the neighbours' matched positions,
/// rounded at the end. `values` gets what each of `nodes` would have in the place of its value in
/// `field`; the same bytes for any instruction set.
void relax_positions(const Graph& graph, const LatticeFrame& frame,
                     const LineConstraints& constraints, int posy, PositionEnergy energy,
                     std::span<const Index> nodes, const Vec3* field, Vec3* values);

}  // namespace meshgrain
