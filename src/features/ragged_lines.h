#pragma once

#include "features/chain_edges.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Lines that were drawn on the surface (LineKind::drawn) and turn sharply where they have no
/// corner, from pixel to pixel or along the sides of triangles, come to run through their mean over
/// `reach` to both sides, less near their ends, which stay; they stay on the surface, or near to
/// it. `edges`: those that the lines are of.
void even_out_ragged_lines(FeatureLines& lines, const Mesh& mesh,
                           const std::vector<EdgeOfLine>& edges, double reach,
                           const Context& context);

}  // namespace meshgrain
