#include "finish/vertex_batches.h"

#include <algorithm>
#include <cstdint>

namespace meshgrain {

std::vector<std::vector<Index>> VertexBatches::operator()(std::span<const Index> vertices) {
  std::vector<std::vector<Index>> result;
  std::vector<std::uint8_t> taken;
  for (const Index v : vertices) {
    taken.assign(result.size() + 1, 0);
    for (const Index f : around_[v]) {
      for (const Index w : mesh_.faces[f]) {
        if (batch_[w] != no_index) taken[batch_[w]] = 1;
      }
    }
    const auto first = std::find(taken.begin(), taken.end(), 0) - taken.begin();
    batch_[v] = static_cast<Index>(first);
    if (batch_[v] == result.size()) result.emplace_back();
    result[batch_[v]].push_back(v);
  }
  for (const Index v : vertices) batch_[v] = no_index;
  return result;
}

}  // namespace meshgrain
