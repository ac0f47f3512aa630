#pragma once

#include <vector>

#include "border/border_loops.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// For each node of a surface, how far the nearest border that stays is, and how long edges must be
/// there so that rows of faces meet its vertices one to one.
struct BorderSpacing {
  std::vector<float> distances, lengths;
};

/// `reach`: over what length of a border the distance between its vertices is a mean; `sides`: of
/// faces, a lattice edge.
BorderSpacing border_spacing(const BorderLoops& borders, const Graph& graph, double reach,
                             double sides, const Context& context);

/// `lengths`, but what they must be on borders, and elsewhere at most `growth` times the distance
/// longer or shorter than on the nearest of these. Where that is never by much, `lengths` as they
/// are.
EdgeLength fit_to_borders(const EdgeLength& lengths, const BorderSpacing& spacing, double growth);

}  // namespace meshgrain
