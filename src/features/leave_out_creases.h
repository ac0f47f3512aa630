#pragma once

#include <vector>

#include "features/chain_edges.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Leaves out creases that run beside another line, so near that faces with sides of `edge_length`
/// cannot keep the two apart: those of narrow chamfers, of thin blades, and of slivers that fold
/// over at a border. Borders and marked edges stay, and the longer of two creases.
std::vector<EdgeOfLine> leave_out_creases_beside_lines(const Mesh& mesh,
                                                       const std::vector<EdgeOfLine>& edges,
                                                       double edge_length, const Context& context);

}  // namespace meshgrain
