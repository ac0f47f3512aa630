#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/uninitialized.h"

namespace meshgrain {

/// What `find(begin, end, part)` puts into a part of its own for each of some ranges that cover
/// [0, count), in parallel; the ranges are the same for any number of threads.
template <typename Part, typename Find>
std::vector<Part> collect_parts(std::size_t count, const Find& find, const Context& context) {
  constexpr std::size_t grain = 1024;
  std::vector<Part> parts((count + grain - 1) / grain);
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    find(begin, end, parts[begin / grain]);
  });
  return parts;
}

/// The lists `list(part)` one after the other, copied in parallel.
template <typename Item, typename Part, typename List>
UninitializedVector<Item> joined(const std::vector<Part>& parts, const List& list,
                                 const Context& context) {
  std::vector<std::size_t> starts{0};
  for (const Part& part : parts) starts.push_back(starts.back() + list(part).size());
  UninitializedVector<Item> result(starts.back());
  context.for_ranges(parts.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::ranges::copy(list(parts[k]), result.begin() + static_cast<std::ptrdiff_t>(starts[k]));
    }
  });
  return result;
}

/// What `find(begin, end, out)` appends to `out` for ranges of [0, count), in parallel; in the
/// order of the ranges, for any number of threads.
template <typename Item, typename Find>
std::vector<Item> collect(std::size_t count, const Find& find, const Context& context) {
  std::vector<Item> result;
  for (const auto& part : collect_parts<std::vector<Item>>(count, find, context))
    result.insert(result.end(), part.begin(), part.end());
  return result;
}

}  // namespace meshgrain
