#pragma once

#include <array>
#include <vector>

#include "meshgrain/fields.h"

namespace meshgrain {

struct OrientationSingularity {
  Index face = 0;
  int index = 0;  ///< In units of 1 / rosy turns.
};

/// The triangles around which an orientation field turns (section 3.6). The turn is measured by
/// parallel transport between the vertices' tangent planes, so that over a closed surface the
/// indices sum to rosy times its Euler number.
std::vector<OrientationSingularity> orientation_singularities(const Mesh& triangles,
                                                              const std::vector<Vec3>& normals,
                                                              const OrientationField& field,
                                                              const Context& context = Context());

struct PositionSingularity {
  Index face = 0;
  std::array<int, 2> jump{0, 0};  ///< What is left of the integer translations around the triangle.
};

/// The triangles around which the integer translations do not cancel, though the rotations do
/// (section 3.6).
std::vector<PositionSingularity> position_singularities(const Mesh& triangles, const Graph& graph,
                                                        const OrientationField& orientation,
                                                        const PositionField& position,
                                                        PositionEnergy energy,
                                                        const Context& context = Context());

}  // namespace meshgrain
