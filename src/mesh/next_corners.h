#pragma once

#include <array>
#include <cstdint>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The corner after v in a triangle, and the one before it: without branches, as no one could
/// predict which corner is v.
inline std::array<Index, 2> next_corners(const Index* triangle, Index v) {
  static constexpr std::uint8_t after[4] = {1, 2, 0, 0}, before[4] = {2, 0, 1, 0};
  const std::size_t corner = (triangle[1] == v) + 2 * (triangle[2] == v);
  return {triangle[after[corner]], triangle[before[corner]]};
}

}  // namespace meshgrain
