#include "mesh/duplicates.h"

#include <atomic>
#include <bit>
#include <cstdint>
#include <utility>

#include "util/hash.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0;
  // Adding zero turns -0, which equals 0 but has other bits, into 0.
  for (int axis = 0; axis < 3; ++axis)
    h = hash64(h + std::bit_cast<std::uint32_t>(p[axis] + 0.0f) + 0x9e3779b97f4a7c15u);
  return h;
}

}  // namespace

std::vector<Index> distinct_positions(std::span<const Vec3> points, std::vector<Index>* first,
                                      const Context& context) {
  // Open addressing with linear probing, at most half full: of each position the lowest point. A
  // slot keeps its position once it has one, so that all threads may fill the table at once.
  const std::size_t mask = std::bit_ceil(2 * points.size() + 1) - 1;
  std::vector<Index> table(mask + 1, no_index);
  std::vector<Index> lowest(points.size());  // for a while its slot
  const auto put = [&](Index i) {
    for (std::size_t slot = hash(points[i]) & mask;; slot = (slot + 1) & mask) {
      const std::atomic_ref own(table[slot]);
      Index there = own.load(std::memory_order_relaxed);
      const bool is_first =
          there == no_index && own.compare_exchange_strong(there, i, std::memory_order_relaxed);
      if (is_first) return static_cast<Index>(slot);
      if (points[there] != points[i]) continue;
      while (i < there && !own.compare_exchange_weak(there, i, std::memory_order_relaxed)) {
      }
      return static_cast<Index>(slot);
    }
  };
  for_indices(
      points.size(), [&](Index i) { lowest[i] = put(i); }, context);
  for_indices(
      points.size(), [&](Index i) { lowest[i] = table[lowest[i]]; }, context);
  std::vector<Index> distinct = indices_where(
      points.size(), [&](Index i) { return lowest[i] == i; }, context);
  if (first == nullptr) return distinct;
  for_indices(
      distinct.size(), [&](Index k) { table[distinct[k]] = k; }, context);
  for_indices(
      points.size(), [&](Index i) { lowest[i] = table[lowest[i]]; }, context);
  *first = std::move(lowest);
  return distinct;
}

}  // namespace meshgrain
