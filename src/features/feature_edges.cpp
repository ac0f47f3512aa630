#include "features/feature_edges.h"

#include <algorithm>

namespace meshgrain {

FeatureEdges::FeatureEdges(const FeatureLines& lines, std::size_t surface_vertices)
    : hold_(surface_vertices, free_vertex) {
  for (Index line = 0; line < lines.size(); ++line) {
    for (Index k = lines.begin(line); k + 1 < lines.end(line); ++k) {
      const Index a = lines.vertices[k], b = lines.vertices[k + 1];
      edges_.push_back({std::min(a, b), std::max(a, b), line});
    }
  }
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
  for (const Index v : lines.vertices) hold_[v] = on_line;
  for (const Index v : lines.corners) hold_[v] = at_corner;
}

Index FeatureEdges::line(Index a, Index b) const {
  if (hold_[a] == free_vertex || hold_[b] == free_vertex) return no_index;
  const std::array key{std::min(a, b), std::max(a, b)};
  const auto it = std::lower_bound(edges_.begin(), edges_.end(), key,
                                   [](const Edge& e, const auto& k) { return e.key() < k; });
  return it != edges_.end() && it->key() == key ? it->line : no_index;
}

}  // namespace meshgrain
