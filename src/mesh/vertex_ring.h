#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "mesh/next_corners.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The neighbours of a vertex of a triangle mesh, and the faces at the edges to them.
class VertexRing {
 public:
  static constexpr std::size_t most = 8;

  /// Finds the ring of v. False if it has more than `most` faces, or if not every edge lies between
  /// two faces of opposite direction.
  bool find(const Mesh& triangles, std::span<const Index> faces, Index v) {
    size_ = faces.size();
    if (size_ > most) return false;
    Few next, last;
    next.fill(no_index);
    last.fill(no_index);
    const Index* const corners = triangles.faces.corners().data();
    for (std::size_t k = 0; k < size_; ++k) {
      const auto [after, before] = next_corners(corners + std::size_t{3} * faces[k], v);
      next[k] = after;
      last[k] = before;
    }
    // Every neighbour comes after v in one face, and before it in another.
    next_ = order_of(next);
    last_ = order_of(last);
    bool is_closed = true;
    for (std::size_t k = 0; k < size_; ++k) {
      neighbors_[k] = next[next_[k]];
      is_closed &= neighbors_[k] == last[last_[k]];
      is_closed &= neighbors_[k] != v && (k == 0 || neighbors_[k] > neighbors_[k - 1]);
    }
    return is_closed;
  }

  /// In increasing order.
  std::span<const Index> neighbors() const { return {neighbors_.data(), size_}; }
  /// Which of the faces have the edges from v to neighbour k, and from k to v.
  std::size_t left(std::size_t k) const { return next_[k]; }
  std::size_t right(std::size_t k) const { return last_[k]; }

 private:
  using Few = std::array<Index, most>;
  using Order = std::array<std::uint32_t, most>;

  /// The places of values in increasing order, if they differ; without branches.
  static Order order_of(const Few& values) {
    std::array<std::uint32_t, most> rank{};
    for (const Index other : values) {
      for (std::size_t k = 0; k < most; ++k) rank[k] += other < values[k];
    }
    Order order{};
    for (std::uint32_t k = 0; k < most; ++k) order[rank[k]] = k;
    return order;
  }

  std::size_t size_ = 0;
  Few neighbors_{};
  Order next_{}, last_{};
};

}  // namespace meshgrain
