#include "mesh/seams.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <vector>

#include "mesh/weld.h"
#include "util/union_find.h"

namespace meshgrain {

SeamReport find_seams(const Mesh& mesh, std::span<const std::array<Index, 2>> border) {
  DistinctPositions distinct;
  std::vector<std::array<Index, 2>> edges;  // between places, as their faces run
  for (const auto& [a, b] : border) {
    const Index from = distinct.add(mesh.positions[a]), to = distinct.add(mesh.positions[b]);
    if (from != to) edges.push_back({from, to});
  }
  std::ranges::sort(edges);
  SeamReport report;
  report.border_edges = edges.size();
  report.seam_edges = static_cast<std::size_t>(std::ranges::count_if(edges, [&](const auto& edge) {
    return std::ranges::binary_search(edges, std::array{edge[1], edge[0]});
  }));
  return report;
}

bool has_short_loops(const Mesh& mesh, std::span<const std::array<Index, 2>> border,
                     double length) {
  UnionFind loops(mesh.positions.size());
  for (const auto& [a, b] : border) loops.unite(a, b);
  std::unordered_map<Index, double> lengths;
  for (const auto& [a, b] : border) {
    lengths[loops.find(a)] += (mesh.positions[b] - mesh.positions[a]).norm();
  }
  const auto is_short = [&](const auto& loop) { return loop.second < length; };
  return 2 * static_cast<std::size_t>(std::ranges::count_if(lengths, is_short)) > lengths.size();
}

}  // namespace meshgrain
