#pragma once

#include "cloud/nearest_neighbors.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Moves the points of a cloud so noisy that its neighbourhoods are no sheets onto the surface that
/// fits larger ones. `nearest` is then of where they are. Returns whether it was so noisy.
bool smooth_noise(Mesh& cloud, Neighborhoods& nearest, const Context& context);

}  // namespace meshgrain
