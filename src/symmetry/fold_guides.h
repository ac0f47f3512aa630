#pragma once

#include <vector>

#include "meshgrain/guides.h"
#include "meshgrain/symmetry.h"

namespace meshgrain {

/// Mirrors what lies below a plane to the side above, which is the half that is remeshed. A guide
/// that crosses the plane becomes several, which end there.
std::vector<Guide> fold_guides(const std::vector<Guide>& guides, const MirrorPlane& plane);

}  // namespace meshgrain
