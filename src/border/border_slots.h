#pragma once

#include <span>
#include <vector>

#include "border/border_loops.h"
#include "border/match_loop.h"
#include "meshgrain/graph.h"
#include "meshgrain/remesh.h"

namespace meshgrain {

/// Where an extracted border is to have vertices, as places among the locked ones of a loop, in
/// order.
using Slots = std::vector<double>;

/// What there is to choose from: all locked vertices. For OutputFaces::quads, whose mesh is still
/// to be split, every second one, from one of several on. `points` are the vertices that the
/// extracted border has.
std::vector<Slots> slot_choices(const BorderLoop& loop, std::span<const BorderPoint> points,
                                const Graph& graph, OutputFaces faces);

}  // namespace meshgrain
