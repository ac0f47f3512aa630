#pragma once

#include <cstddef>
#include <vector>

#include "meshgrain/context.h"

namespace meshgrain {

/// What `find(begin, end, out)` appends to `out` for ranges of [0, count), in parallel; in the
/// order of the ranges, for any number of threads.
template <typename Item, typename Find>
std::vector<Item> collect(std::size_t count, const Find& find, const Context& context) {
  constexpr std::size_t grain = 1024;
  std::vector<std::vector<Item>> parts((count + grain - 1) / grain);
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    find(begin, end, parts[begin / grain]);
  });
  std::vector<Item> result;
  for (const auto& part : parts) result.insert(result.end(), part.begin(), part.end());
  return result;
}

}  // namespace meshgrain
