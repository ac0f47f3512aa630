#include "cloud/cloud_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cloud/cloud_normals.h"
#include "cloud/spacing.h"
#include "graph/gather_neighbors.h"
#include "mesh/sort_by_vertex.h"
#include "meshgrain/error.h"
#include "util/collect.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 4096;

}  // namespace

Graph cloud_graph(const Mesh& cloud, const Neighborhoods& nearest, const GraphOptions& options,
                  const Context& context) {
  if (cloud.positions.size() < 4) throw Error("a point cloud needs at least four points");
  Graph graph;
  graph.positions = cloud.positions;
  graph.normals = cloud_normals(cloud, nearest, context);
  const std::size_t n = cloud.positions.size();

  // Being among the nearest is not mutual, but the fields need every edge from both ends.
  struct Edge {
    Index from, to;
  };
  const auto find_one_sided = [&](std::size_t begin, std::size_t end, std::vector<Edge>& out) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      for (const Index j : nearest[i]) {
        if (std::ranges::find(nearest[j], i) == nearest[j].end()) out.push_back({j, i});
      }
    }
  };
  const std::vector<Edge> one_sided = collect<Edge>(n, find_one_sided, context);
  UninitializedVector<Index> others(one_sided.size());
  const std::vector<Index> offsets = sort_by_vertex(
      one_sided.size(), n, [&](std::size_t e) { return std::array{one_sided[e].from}; },
      [&](std::size_t e, Index place) { others[place] = one_sided[e].to; }, context);
  gather_neighbors(
      graph,
      [&](Index i, std::vector<Index>& out) {
        const auto start = static_cast<std::ptrdiff_t>(out.size());
        out.insert(out.end(), nearest[i].begin(), nearest[i].end());
        out.insert(out.end(), others.begin() + offsets[i], others.begin() + offsets[i + 1]);
        std::sort(out.begin() + start, out.end());
      },
      context);

  graph.areas = squared_distances(graph.positions, nearest, context);
  std::vector<float> scale;
  if (options.weights == GraphWeights::geometric) scale = graph.areas;
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      graph.areas[i] = area_of_point(graph.areas[i], nearest[i].size());
    }
  });
  if (options.weights == GraphWeights::uniform) return graph;
  graph.weights.resize(graph.neighbors.size());
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
        // The heat kernel of Belkin et al. 2009, at the mean of both ends' scales: weights must be
        // the same from either end, or there is no energy that the local steps lower.
        const Index j = graph.neighbors[e];
        const float d = (graph.positions[j] - graph.positions[i]).squaredNorm();
        const float both = scale[i] + scale[j];
        graph.weights[e] = both > 0 ? std::max(std::exp(-d / both), 0.01f) : 1.0f;
      }
    }
  });
  return graph;
}

}  // namespace meshgrain
