#pragma once

#include <cstddef>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "util/collect.h"

namespace meshgrain {

/// Calls `body(i)` for all i in [0, count), in parallel: for bodies that take little time each.
template <typename Body>
void for_indices(std::size_t count, const Body& body, const Context& context) {
  context.for_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) body(i);
  });
}

/// Those in [0, count) for which `condition(i)` holds, increasing; found in parallel.
template <typename Condition>
std::vector<Index> indices_where(std::size_t count, const Condition& condition,
                                 const Context& context) {
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (condition(i)) out.push_back(i);
    }
  };
  return collect<Index>(count, look, context);
}

}  // namespace meshgrain
