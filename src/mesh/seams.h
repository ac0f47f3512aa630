#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "meshgrain/mesh.h"

namespace meshgrain {

struct SeamReport {
  std::size_t border_edges = 0;
  /// Those that lie on others, between vertices at exactly the same places: so programs write
  /// meshes that have several normals or texture coordinates at a vertex.
  std::size_t seam_edges = 0;

  bool are_many() const {
    constexpr std::size_t many = 4;  // one in so many: pieces may touch by chance
    return seam_edges > 0 && many * seam_edges >= border_edges;
  }
  bool are_all() const { return seam_edges > 0 && seam_edges == border_edges; }
};

/// Of the edges of the border, which are given, those that would go if vertices at one place were
/// merged.
SeamReport find_seams(const Mesh& mesh, std::span<const std::array<Index, 2>> border);

/// Of the edges of the border, which are given: whether most of the loops that they make are
/// shorter than `length`.
bool has_short_loops(const Mesh& mesh, std::span<const std::array<Index, 2>> border, double length);

}  // namespace meshgrain
