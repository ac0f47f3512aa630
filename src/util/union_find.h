#pragma once

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Disjoint sets of 0 ... count - 1, with path halving.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  Index find(Index x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }

  /// Joins two sets; false if they were one already.
  bool unite(Index a, Index b) {
    a = find(a), b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  std::vector<Index> parent_;
};

/// Disjoint sets of 0 ... count - 1 that several threads may unite at once. The root of a set is
/// its lowest member, whatever the order.
class SharedUnionFind {
 public:
  explicit SharedUnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  Index find(Index x) {
    for (Index up = parent(x); up != x;) {
      const Index above = parent(up);
      // Whatever others have written here meanwhile, this too lies on the way to the root.
      if (above != up) at(x).store(above, std::memory_order_relaxed);
      x = up;
      up = above;
    }
    return x;
  }

  void unite(Index a, Index b) {
    for (;;) {
      a = find(a), b = find(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      Index alone = a;  // unless somebody else was quicker
      if (at(a).compare_exchange_weak(alone, b, std::memory_order_relaxed)) return;
    }
  }

 private:
  std::atomic_ref<Index> at(Index x) { return std::atomic_ref(parent_[x]); }
  Index parent(Index x) { return at(x).load(std::memory_order_relaxed); }

  std::vector<Index> parent_;
};

}  // namespace meshgrain
