#pragma once

#include <span>
#include <vector>

#include "meshgrain/fields.h"

namespace meshgrain {

/// Constraints of one level, dense: strength 0 where there is none. Empty if the level has none.
struct DirectionConstraints {
  std::vector<Vec3> directions;
  std::vector<float> strengths;
};

/// Eq. 3 for several nodes at once, for the extrinsic and the intrinsic energy: the integers of
/// each edge are chosen just before its neighbour is added, against the sum so far. `values` gets
/// what each of `nodes` would have in the place of its value in `field`; the same bytes for any
/// instruction set.
void relax_orientations(const Graph& graph, const DirectionConstraints& constraints, int rosy,
                        OrientationEnergy energy, std::span<const Index> nodes, const Vec3* field,
                        Vec3* values);

}  // namespace meshgrain
