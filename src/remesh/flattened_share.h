#pragma once

#include "meshgrain/hierarchy.h"

namespace meshgrain {

/// What share of a surface's area is left when patches of about `patch` each are flattened along
/// their mean normals: 1 for a plane, less where the surface bends or is rough within a patch. What
/// bends by more than a crease does stays as it is.
double flattened_share(const Hierarchy& hierarchy, double patch, const Context& context);

/// What share of a surface's area bends so much one way that a tube that did would have fewer than
/// three edges of that length around it. Noise counts for little.
double share_of_thin_tubes(const Hierarchy& hierarchy, double length, const Context& context);

}  // namespace meshgrain
