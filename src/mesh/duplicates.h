#pragma once

#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The points whose position no earlier point has, in order; `first`, if wanted, gets the place in
/// that list of every point's position. Positions are equal if their coordinates are (0 and -0
/// too).
std::vector<Index> distinct_positions(std::span<const Vec3> points, std::vector<Index>* first,
                                      const Context& context);

}  // namespace meshgrain
