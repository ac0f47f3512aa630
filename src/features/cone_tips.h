#pragma once

#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/features.h"
#include "meshgrain/graph.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The tips of cones, in increasing order: vertices with at least a sixth of a turn less around
/// them than in a plane, and with no sharp edge, where the surface is otherwise hardly bent in
/// itself, and has no line, as far as `edge_length` away. `graph`: of the vertices of the mesh.
std::vector<Index> find_cone_tips(const Mesh& triangles, const Graph& graph,
                                  const FeatureLines& lines, double edge_length,
                                  const Context& context);

}  // namespace meshgrain
