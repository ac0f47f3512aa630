#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// An edge as the vertices at its ends, the smaller index first.
inline std::array<Index, 2> edge_of(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

/// For hash tables of edges.
inline std::uint64_t key_of(const std::array<Index, 2>& edge) {
  return std::uint64_t{edge[0]} << 32 | edge[1];
}

}  // namespace meshgrain
