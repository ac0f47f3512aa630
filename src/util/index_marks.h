#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Marks on numbered things, a bit each: what a loop must look at, or at again.
class IndexMarks {
 public:
  void set(Index i) {
    if (i / 64 >= words_.size()) words_.resize(i / 64 + 1 + i / 512, 0);
    words_[i / 64] |= std::uint64_t{1} << i % 64;
  }

  void clear(Index i) { words_[i / 64] &= ~(std::uint64_t{1} << i % 64); }

  /// The first in [i, end) that has a mark, or no_index.
  Index first(Index i, Index end = no_index) const {
    for (std::size_t w = i / 64; w < words_.size(); ++w, i = 0) {
      const std::uint64_t rest = words_[w] >> i % 64 << i % 64;
      if (rest == 0) continue;
      const auto found = static_cast<Index>(64 * w + std::countr_zero(rest));
      return found < end ? found : no_index;
    }
    return no_index;
  }

  /// Takes the mark from that. In a loop, what is marked behind waits for the next one.
  Index take(Index i, Index end) {
    const Index found = first(i, end);
    if (found != no_index) clear(found);
    return found;
  }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace meshgrain
