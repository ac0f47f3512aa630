#pragma once

#include <array>
#include <span>
#include <vector>

#include "features/cut_guides.h"
#include "meshgrain/features.h"

namespace meshgrain {

/// The creases that are not marked, as the vertices at their ends, for faces with sides of
/// `edge_length`.
std::vector<std::array<Index, 2>> find_creases(const Mesh& triangles, const FeatureOptions& options,
                                               double edge_length, const Context& context);

/// The edges of the border and of the creases, each once, but for creases that faces with sides of
/// `edge_length` could not follow. `cuts`: more edges, sorted, that are lines as the border is.
/// `room`: if not 0, how long the sides of faces may be for which leave_out_fragments() leaves what
/// is not the border.
std::vector<EdgeOfLine> feature_edges(const Mesh& triangles, const FeatureOptions& options,
                                      double edge_length, const Context& context,
                                      std::span<const std::array<Index, 2>> cuts = {},
                                      double room = 0);

/// The public find_features() with guides that were cut into the mesh, and the edges at which it
/// was cut itself. Guides that run along a border or a crease are part of that. `room`: that of
/// feature_edges().
FeatureLines find_features(const Mesh& triangles, const FeatureOptions& options,
                           const GuideLines& guides, std::span<const std::array<Index, 2>> cuts,
                           double edge_length, double room, const Context& context);

}  // namespace meshgrain
