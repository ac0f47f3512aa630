#pragma once

#include <array>
#include <vector>

#include "meshgrain/features.h"

namespace meshgrain {

/// How much of its freedom a vertex has lost to feature lines.
enum Hold : std::uint8_t { free_vertex, on_line, at_corner };

/// Feature lines by the edges and vertices of the surface.
class FeatureEdges {
 public:
  FeatureEdges(const FeatureLines& lines, std::size_t surface_vertices);

  /// The line that the edge between two vertices is part of, or no_index.
  Index line(Index a, Index b) const;
  Hold hold(Index vertex) const { return static_cast<Hold>(hold_[vertex]); }
  /// That of each vertex.
  const std::vector<std::uint8_t>& holds() const { return hold_; }

 private:
  struct Edge {
    std::array<Index, 2> ends;
    Index line;
  };
  std::vector<Edge> edges_;  // sorted
  std::vector<std::uint8_t> hold_;
};

}  // namespace meshgrain
