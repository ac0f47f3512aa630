#include <algorithm>

#include "features/chain_edges.h"
#include "features/mechanical_creases.h"
#include "mesh/border.h"
#include "meshgrain/features.h"

namespace meshgrain {

bool FeatureLines::is_closed(std::size_t line) const {
  const Index v = vertices[begin(line)];
  return v == vertices[end(line) - 1] && !std::binary_search(corners.begin(), corners.end(), v);
}

FeatureLines find_features(const Mesh& mesh, const FeatureOptions& options, double edge_length,
                           const Context& context) {
  std::vector<std::array<Index, 2>> creases;
  if (options.creases == Creases::automatic) creases = mechanical_creases(mesh, context);
  if (options.creases == Creases::by_angle) {
    creases = crease_edges(mesh, options.crease_degrees, context);
  }
  std::vector<EdgeOfLine> edges;
  for (const auto& ends : rim_edges(mesh, context)) edges.push_back({ends, LineKind::border});
  for (const auto& ends : creases) edges.push_back({ends, LineKind::crease});
  return chain_edges(mesh, edges, options, edge_length);
}

}  // namespace meshgrain
