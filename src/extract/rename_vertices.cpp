#include "extract/rename_vertices.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "util/sort_unique.h"

namespace meshgrain {

void rename_vertices(Extraction& extraction, std::span<const Index> becomes) {
  for (Index& v : extraction.mesh.faces.corners()) v = becomes[v];
  for (Index& v : extraction.corners) v = becomes[v];
  sort_unique(extraction.corners);
  std::vector<LineEdge>& edges = extraction.line_edges;
  for (LineEdge& edge : edges) {
    std::tie(edge.a, edge.b) = std::minmax({becomes[edge.a], becomes[edge.b]});
  }
  std::ranges::sort(edges, {}, [](const LineEdge& e) { return std::tuple(e.a, e.b, e.line); });
  const auto rest =
      std::ranges::unique(edges, {}, [](const LineEdge& e) { return std::pair(e.a, e.b); });
  edges.erase(rest.begin(), rest.end());
}

}  // namespace meshgrain
