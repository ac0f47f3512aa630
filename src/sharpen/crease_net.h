#pragma once

#include <array>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Makes connected lines of edges that were found one by one: of rings of a few edges the least
/// sharp one goes, gaps of a few are bridged along the sharpest way, and twigs and pieces shorter
/// than `shortest` go.
std::vector<std::array<Index, 2>> connect_creases(const Mesh& triangles,
                                                  const std::vector<std::array<Index, 2>>& edges,
                                                  double shortest, const Context& context);

/// Of lines that are connected already, drops rings of a few edges, twigs and pieces shorter than
/// `shortest`.
std::vector<std::array<Index, 2>> drop_scraps(const Mesh& triangles,
                                              const std::vector<std::array<Index, 2>>& edges,
                                              double shortest, const Context& context);

}  // namespace meshgrain
