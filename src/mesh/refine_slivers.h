#pragma once

#include <span>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Splits the edges of a triangle mesh that are longer than `max_length` where subdivide() would
/// make far too many vertices of it: long, thin triangles, as tessellations of cylinders and cones
/// consist of. The longest edges are split first, and then edges between triangles that are nearly
/// in a plane turned to the other diagonal where that is Delaunay, so that few vertices serve many
/// slivers. The surface moves by about a hundredth of `max_length`; marked, border and
/// non-manifold edges stay where they are. Returns false, having done nothing, where slivers are
/// few. `long_faces` are all that have an edge of more than that length.
bool refine_slivers(Mesh& triangles, double max_length, std::span<const Index> long_faces,
                    const Context& context);

}  // namespace meshgrain
