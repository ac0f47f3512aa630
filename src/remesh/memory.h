#pragma once

#include "meshgrain/remesh.h"
#include "remesh/target.h"

namespace meshgrain {

/// Throws Error if remeshing this input may take more than RemeshOptions::memory_limit, of the
/// program as a whole. What it takes without retries is estimated from measured runs: an upper
/// bound, as a rule by no more than two thirds too high. Returns whether there is room for
/// RemeshOptions::retries as well.
bool check_memory(const Mesh& input, const RemeshOptions& options, const Context& context);

/// The refusal alone, where coarsen() has left a surface of this area: on a rough one it may leave
/// more than check_memory() expects.
void check_memory_of_coarse(const Mesh& surface, double area, const RemeshOptions& options,
                            const Target& target, const Context& context);

}  // namespace meshgrain
