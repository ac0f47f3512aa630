#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "meshgrain/context.h"

namespace meshgrain {

/// The sum of `part(begin, end)` over ranges of [0, count), in parallel: the same for any number of
/// threads, as the ranges are.
template <typename Part>
auto sum_over_ranges(std::size_t count, const Part& part, const Context& context) {
  constexpr std::size_t grain = 8192;
  using Sum = decltype(part(std::size_t{}, std::size_t{}));
  std::vector<Sum> parts((count + grain - 1) / grain);
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    parts[begin / grain] = part(begin, end);
  });
  return std::accumulate(parts.begin(), parts.end(), Sum{});
}

}  // namespace meshgrain
