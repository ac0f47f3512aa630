#pragma once

#include <cstdint>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Area-weighted means over the children of coarse nodes, a child at a time: how much of the mean
/// came before each child.
class RunningShare {
 public:
  explicit RunningShare(std::size_t nodes) : area_(nodes, -1) {}

  bool is_first(Index node) const { return area_[node] < 0; }

  /// Adds a child; returns the share of those before it (0 for the first).
  float add(Index node, float area) {
    const bool first = is_first(node);
    const float before = first ? 0 : area_[node];
    area_[node] = before + area;
    return area_[node] > 0 ? before / area_[node] : first ? 0.0f : 0.5f;
  }

 private:
  std::vector<float> area_;
};

}  // namespace meshgrain
