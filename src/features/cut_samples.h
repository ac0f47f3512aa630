#pragma once

#include <vector>

#include "mesh/cut_apart.h"
#include "meshgrain/features.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// Points of the lattice along the lines at which a surface was cut, for all of its sides the same,
/// so that the faces of these have vertices in common: evenly spaced between the ends of the lines
/// and the corners of `features`, about as far apart as the edges of the lattice are long.
std::vector<PositionConstraint> sample_cuts(const Cuts& cuts, const Mesh& surface,
                                            const FeatureLines& features,
                                            const EdgeLength& lengths);

}  // namespace meshgrain
