#pragma once

#include <vector>

#include "meshgrain/features.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// Of the length of the lines that orientations are not held to: the share that runs askew to the
/// crosses (of a 4-RoSy) on it. `normals`: of the surface.
double share_askew(const FeatureLines& lines, const std::vector<Vec3>& normals,
                   const OrientationField& field);

/// The constraints that hold orientations to those lines.
std::vector<OrientationConstraint> hold_to_lines(FeatureLines lines);

}  // namespace meshgrain
