#pragma once

#include "extract/lattice_mesh.h"

namespace meshgrain {

/// Removes position singularities by changing integers along paths from one to another, to a
/// singularity of the orientation field, or to the border; the cheapest first. `cost` is the most
/// that may be spent for each irregular vertex that goes away: the sum over the edges crossed by
/// how much farther (squared, in edge lengths) the new jump is from the real distance of the ends.
void cancel_position_singularities(LatticeMesh& lattice, double cost, const Context& context);

}  // namespace meshgrain
