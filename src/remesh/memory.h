#pragma once

#include "meshgrain/remesh.h"

namespace meshgrain {

/// Throws Error if remeshing this input may take more than RemeshOptions::memory_limit, of the
/// program as a whole. What it takes is estimated from measured runs: an upper bound, as a rule by
/// no more than two thirds too high.
void check_memory(const Mesh& input, const RemeshOptions& options, const Context& context);

}  // namespace meshgrain
