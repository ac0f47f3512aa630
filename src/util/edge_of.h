#pragma once

#include <algorithm>
#include <array>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// An edge as the vertices at its ends, the smaller index first.
inline std::array<Index, 2> edge_of(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace meshgrain
