#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

struct Neighborhoods {
  std::size_t k = 0;
  std::vector<Index> indices;  ///< k a point, nearest first; no_index at the end where fewer exist.

  /// The neighbours of point `i`, without the empty places.
  std::span<const Index> operator[](std::size_t i) const {
    std::size_t n = k;
    while (n > 0 && indices[i * k + n - 1] == no_index) --n;
    return {indices.data() + i * k, n};
  }
};

/// The `k` nearest other positions of each point. Points that share a position say nothing about
/// the surface: they are no neighbours of each other, and only the first of them is a neighbour of
/// others. Of equally distant points the earlier comes first. Any order of the points gives the
/// same neighbours; a spatially coherent one is faster.
Neighborhoods nearest_neighbors(std::span<const Vec3> points, std::size_t k,
                                const Context& context = Context());

/// Leaves out neighbours that look about the other way: across a thin part, to its other side.
void leave_out_other_sides(Neighborhoods& nearest, std::span<const Vec3> normals,
                           const Context& context = Context());

/// For each query the index of the nearest of `points`, of which there must be one at least.
std::vector<Index> nearest_points(std::span<const Vec3> points, std::span<const Vec3> queries,
                                  const Context& context = Context());

}  // namespace meshgrain
