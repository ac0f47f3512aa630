#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Up to which widths bends go, from side to side: those of a few sharp folds, which faces follow
/// well, and those that are round, and wider.
struct BendWidths {
  double chamfer, rounding;
};

/// Makes sharp creases of the narrow chamfers and roundings of a mechanical part: what lies across
/// one becomes a vertex where the sides beyond it meet. Topology and border stay, and so does what
/// cannot go without turning the sides. Returns the triangles that were bent, as they were, with
/// how far each of their vertices went as `values`.
Mesh sharpen_bends(Mesh& triangles, const BendWidths& widths, const Context& context);

}  // namespace meshgrain
