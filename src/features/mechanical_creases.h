#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/border.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Below the one edges are flat, beyond the other they are sharp.
inline constexpr double flat_degrees = 10, sharp_degrees = 40;

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

/// What a surface may be by its edges that are not flat.
enum class SurfaceKind {
  mechanical_part,  ///< Most are either nearly flat or creases; or, where coarse facets round it,
                    ///< its sharp edges make clean lines.
  rounded_part,     ///< There is much of anything between its creases and what is nearly flat, but
                    ///< many sharp edges lie on clean lines, and a good part of them stick out: the
  ///< seams where bodies of a sculpture meet are clean, too, but hollow. Or nearly
  ///< all do once the facets of a coarse round side may meet them.
  sculpture,  ///< Or a scan: sharp edges are detail or noise.
};
SurfaceKind kind_of_surface(const Mesh& triangles, const RimAndSharpEdges& edges,
                            const Context& context);

/// The creases of a mechanical part.
std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& triangles,
                                                     std::span<const SharpEdge> edges,
                                                     const Context& context);

}  // namespace meshgrain
