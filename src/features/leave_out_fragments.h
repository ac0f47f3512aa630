#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Of the creases of a sculpture or a scan, those that faces with sides of `edge_length` can
/// follow: ends that lead nowhere are left out if they are a few sides long, and so are lines that
/// hang together with nothing, and those that run nowhere far from longer ones. What is left out
/// goes with the sharp edges of detail, which faces of this size cannot show. The rim stays, and
/// creases may end there. `creases` are sorted, and so is the result.
std::vector<std::array<Index, 2>> leave_out_fragments(const Mesh& mesh,
                                                      std::span<const std::array<Index, 2>> rim,
                                                      std::vector<std::array<Index, 2>> creases,
                                                      double edge_length);

}  // namespace meshgrain
