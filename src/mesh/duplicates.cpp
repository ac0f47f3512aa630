#include "mesh/duplicates.h"

#include <bit>
#include <cstdint>

#include "util/hash.h"

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

std::vector<Index> distinct_positions(std::span<const Vec3> points, std::vector<Index>* first) {
  // Open addressing with linear probing, at most half full.
  const std::size_t mask = std::bit_ceil(2 * points.size() + 1) - 1;
  std::vector<Index> table(mask + 1, no_index);
  std::vector<Index> distinct;
  if (first) first->resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t slot = hash(points[i]) & mask;
    while (table[slot] != no_index && points[distinct[table[slot]]] != points[i])
      slot = (slot + 1) & mask;
    if (table[slot] == no_index) {
      table[slot] = static_cast<Index>(distinct.size());
      distinct.push_back(static_cast<Index>(i));
    }
    if (first) (*first)[i] = table[slot];
  }
  return distinct;
}

}  // namespace meshgrain
