#pragma once

#include <limits>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// How dense a cloud has to stay: that it has so many points at least, and that cubic cells it is
/// divided into are not wider than that.
struct CloudDensity {
  double points = 0;
  double cell = std::numeric_limits<double>::infinity();
};

/// Leaves as many points as are `enough`, about evenly spread, of a cloud along the Hilbert curve
/// that has many more: each is the mean of those in a cell, which takes some noise away as well; of
/// a cell through a thin part, one for each side if the points have normals. Returns whether it
/// did.
bool thin_out(Mesh& cloud, const CloudDensity& enough, const Context& context);

}  // namespace meshgrain
