#pragma once

#include "meshgrain/remesh.h"
#include "remesh/target.h"

namespace meshgrain {

/// Throws Error if remeshing this input may take more than RemeshOptions::memory_limit, of the
/// program as a whole. What it takes is estimated from measured runs: an upper bound, as a rule by
/// no more than two thirds too high.
void check_memory(const Mesh& input, const RemeshOptions& options, const Context& context);

/// Whether the limit leaves room for RemeshOptions::retries, too.
bool has_memory_for_retries(const Mesh& input, const RemeshOptions& options,
                            const Context& context);

/// check_memory() where coarsen() has left a surface of this area: on a rough one it may leave more
/// than check_memory() expects.
void check_memory_of_coarse(const Mesh& surface, double area, const RemeshOptions& options,
                            const Target& target, const Context& context);

}  // namespace meshgrain
