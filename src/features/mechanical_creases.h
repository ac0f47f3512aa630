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
CreaseLengths crease_lengths(const Mesh& triangles, std::span<const SharpEdge> edges,
                             const Context& context);

/// The edges sharper than an angle at which it matters least, if there is `clearly` more of clear
/// creases than of what is neither sharp nor flat; else none. `edges` are all that are not flat.
std::vector<std::array<Index, 2>> clear_creases(const Mesh& triangles,
                                                std::span<const SharpEdge> edges, double clearly,
                                                const Context& context);

/// The creases of a mechanical part; nothing for a sculpture or a scan, whose sharp edges are
/// detail or noise. In a part most edges are either nearly flat or creases; or, where coarse facets
/// round it, its sharp edges make clean lines. `edges` are all that are not flat.
std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& triangles,
                                                     const RimAndSharpEdges& edges,
                                                     const Context& context);

/// Whether a surface without these is a part all the same, so rounded that between its creases and
/// what is nearly flat there is much of anything: most edges sharper than `degrees` lie on clean
/// lines then, and a good part of them stick out. The seams where bodies of a sculpture meet are
/// clean, too, but hollow. `edges` are all that are not flat.
bool is_rounded_part(const Mesh& triangles, const RimAndSharpEdges& edges, double degrees,
                     const Context& context);

}  // namespace meshgrain
