#pragma once

#include <array>
#include <span>

#include "meshgrain/polylines.h"

namespace meshgrain {

/// Joins edges to lines: through points where two edges meet, up to those where one ends or more
/// meet. Each edge counts once, however often and in whichever direction it is given; edges from a
/// point to itself are left out. The result has no points yet, only indices, below `count`.
Polylines join_edges(std::span<const std::array<Index, 2>> edges, std::size_t count);

}  // namespace meshgrain
