#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/border.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Below this edges are flat.
inline constexpr double flat_degrees = 10;

/// How long the edges are that are sharp, and those that are neither sharp nor flat. `edges` are
/// all that are not flat.
struct CreaseLengths {
  double clear, doubtful;
};
CreaseLengths crease_lengths(const Mesh& triangles, std::span<const SharpEdge> edges);

/// The creases of a mechanical part; nothing for a sculpture or a scan, whose sharp edges are
/// detail or noise. In a part edges are either nearly flat or creases, of which there are `clearly`
/// times as much as of all in between; or, where coarse facets round it, its sharp edges make clean
/// lines. `edges` are all that are not flat.
std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& triangles,
                                                     const RimAndSharpEdges& edges,
                                                     double clearly);
std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& triangles, double clearly,
                                                     const Context& context);

}  // namespace meshgrain
