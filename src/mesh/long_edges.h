#pragma once

#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The triangles that have an edge longer than this, in increasing order.
std::vector<Index> faces_with_long_edges(const Mesh& triangles, double max_length,
                                         const Context& context);

/// subdivide(), where these are known.
void subdivide_faces(Mesh& triangles, double max_length, std::vector<Index> long_faces,
                     const Context& context);

}  // namespace meshgrain
