#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Calls `body(i, parents[i])` for all nodes i of one level of a hierarchy, in parallel; but of the
/// nodes with the same parent one after the other, in order.
template <typename Body>
void for_each_child(const std::vector<Index>& parents, const Body& body, const Context& context) {
  constexpr std::size_t grain = 4096;
  const std::size_t ranges = (parents.size() + grain - 1) / grain;
  // Parents are numbered by their first children: those that a range is the first to meet are its
  // own, and children of others, of which there are few, wait until all ranges are done.
  std::vector<Index> first(ranges + 1, 0);
  context.for_ranges(parents.size(), grain, [&](std::size_t begin, std::size_t end) {
    first[begin / grain + 1] =
        *std::max_element(parents.begin() + static_cast<std::ptrdiff_t>(begin),
                          parents.begin() + static_cast<std::ptrdiff_t>(end)) +
        1;
  });
  for (std::size_t r = 0; r < ranges; ++r) first[r + 1] = std::max(first[r], first[r + 1]);
  std::vector<std::vector<Index>> late(ranges);
  context.for_ranges(parents.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (parents[i] < first[begin / grain]) {
        late[begin / grain].push_back(i);
      } else {
        body(i, parents[i]);
      }
    }
  });
  for (const std::vector<Index>& nodes : late) {
    for (const Index i : nodes) body(i, parents[i]);
  }
}

}  // namespace meshgrain
