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

  /// Takes the mark from the first in [i, end) that has one, and returns it; or no_index. In a
  /// loop, what is marked behind waits for the next one.
  Index take(Index i, Index end) {
    for (std::size_t w = i / 64; w < words_.size(); ++w, i = 0) {
      const std::uint64_t rest = words_[w] >> i % 64 << i % 64;
      if (rest == 0) continue;
      const auto first = static_cast<Index>(64 * w + std::countr_zero(rest));
      if (first >= end) break;
      words_[w] &= ~(rest & -rest);
      return first;
    }
    return no_index;
  }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace meshgrain
