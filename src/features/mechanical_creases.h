#pragma once

#include <array>
#include <vector>

#include "mesh/border.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The creases of a mechanical part; nothing for a sculpture or a scan, whose sharp edges are
/// detail or noise. Told by the length of edges of every sharpness: in a part they are either
/// nearly flat or creases, of which there are `clearly` times as much as of all in between.
/// `edges` are all that are sharper than `flat_degrees`.
inline constexpr double flat_degrees = 10;
std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& triangles,
                                                     const std::vector<SharpEdge>& edges,
                                                     double clearly);
std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& triangles, double clearly,
                                                     const Context& context);

}  // namespace meshgrain
