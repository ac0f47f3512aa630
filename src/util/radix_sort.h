#pragma once

#include <cstdint>
#include <vector>

#include "meshgrain/context.h"

namespace meshgrain {

/// Sorts numbers by their upper 32 bits, of which only the lower `bits` are in use; those with the
/// same ones keep their order. In linear time, and in parallel.
void radix_sort_by_upper(std::vector<std::uint64_t>& numbers, int bits, const Context& context);

}  // namespace meshgrain
