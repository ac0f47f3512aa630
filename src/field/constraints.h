#pragma once

#include <span>
#include <vector>

#include "field/orientation_kernel.h"
#include "field/position_kernel.h"

namespace meshgrain {

/// Constraints for every level: merged pairs share the mean of theirs, weighted by strength
/// (section 3.7). All levels are empty if there are none.
std::vector<DirectionConstraints> spread_constraints(
    const Hierarchy& hierarchy, int rosy, std::span<const OrientationConstraint> constraints);
std::vector<LineConstraints> spread_constraints(const Hierarchy& hierarchy,
                                                std::span<const PositionConstraint> constraints);

}  // namespace meshgrain
