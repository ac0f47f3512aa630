#include "features/feature_edges.h"

#include <algorithm>

#include "util/edge_of.h"

namespace meshgrain {

FeatureEdges::FeatureEdges(const FeatureLines& lines, std::size_t surface_vertices)
    : hold_(surface_vertices, free_vertex) {
  for (Index line = 0; line < lines.size(); ++line) {
    for (Index k = lines.begin(line); k + 1 < lines.end(line); ++k) {
      edges_.push_back({edge_of(lines.vertices[k], lines.vertices[k + 1]), line});
    }
  }
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
  for (const Index v : lines.vertices) hold_[v] = on_line;
  for (const Index v : lines.corners) hold_[v] = at_corner;
}

Index FeatureEdges::line(Index a, Index b) const {
  if (hold_[a] == free_vertex || hold_[b] == free_vertex) return no_index;
  const auto ends = edge_of(a, b);
  const auto it = std::lower_bound(edges_.begin(), edges_.end(), ends,
                                   [](const Edge& e, const auto& k) { return e.ends < k; });
  return it != edges_.end() && it->ends == ends ? it->line : no_index;
}

}  // namespace meshgrain
