#pragma once

#include <cstddef>

namespace meshgrain::bench {

/// Multiplies and adds in single precision, `rounds` times in as many independent chains as a core
/// needs to be busy; by the widest vectors that the processor has. Returns how many pairs of a
/// multiplication and an addition that were; `result` gets something that depends on all of them.
std::size_t multiply_add(std::size_t rounds, float& result);

}  // namespace meshgrain::bench
