#include "border/border_sizing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "graph/spread.h"

namespace meshgrain {
namespace {

/// For each locked vertex the mean distance between those around it.
std::vector<float> mean_distances(const BorderLoop& loop, const Graph& graph, double reach) {
  constexpr double least = 1e-3;  // of a face: faces for shorter edges would be without number
  const std::size_t count = loop.locked.size();
  std::vector<double> ways(3 * count + 1, 0);  // three times around
  for (std::size_t k = 0; k < 3 * count; ++k) {
    const Vec3& p = graph.positions[loop.locked[k % count]];
    const Vec3& q = graph.positions[loop.locked[(k + 1) % count]];
    ways[k + 1] = ways[k] + (q - p).norm();
  }
  std::vector<float> result(count);
  std::size_t begin = 0, end = count;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t middle = k + count;
    begin = std::max(begin, middle - count / 2);
    while (begin + 1 < middle && ways[middle] - ways[begin + 1] >= reach) ++begin;
    end = std::max(end, middle + 1);
    while (end < middle + count / 2 && ways[end] - ways[middle] < reach) ++end;
    const double mean = (ways[end] - ways[begin]) / static_cast<double>(end - begin);
    result[k] = static_cast<float>(std::max(mean, least * reach));
  }
  return result;
}

}  // namespace

BorderSpacing border_spacing(const BorderLoops& borders, const Graph& graph, double reach,
                             double sides, const Context& context) {
  BorderSpacing result;
  auto& [distances, lengths] = result;
  distances.assign(graph.size(), std::numeric_limits<float>::infinity());
  lengths.assign(graph.size(), 0);
  std::vector<std::pair<float, Index>> sources;
  for (const BorderLoop& loop : borders.loops) {
    const std::vector<float> means = mean_distances(loop, graph, reach);
    for (std::size_t k = 0; k < loop.vertices.size(); ++k) {
      const Index node = loop.vertices[k];
      if (distances[node] == 0) continue;
      distances[node] = 0;
      lengths[node] = static_cast<float>(sides) * means[static_cast<std::size_t>(loop.places[k])];
      sources.push_back({0.0f, node});
    }
  }
  const auto go_on = [&](Index i, Index j) {
    const float way = distances[i] + (graph.positions[j] - graph.positions[i]).norm();
    if (!(way < distances[j])) return false;
    distances[j] = way;
    lengths[j] = lengths[i];
    return true;
  };
  spread(graph, distances, sources, 1, go_on, context);
  return result;
}

EdgeLength fit_to_borders(const EdgeLength& lengths, const BorderSpacing& spacing, double growth) {
  constexpr float alike = 1.1f, longest = 4;
  const std::size_t count = spacing.distances.size();
  bool fits = true;
  for (std::size_t i = 0; i < count && fits; ++i) {
    const float ratio = spacing.lengths[i] / lengths[i];
    fits = spacing.distances[i] > 0 || (ratio < alike && ratio * alike > 1);
  }
  if (fits) return lengths;
  std::vector<float> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    result[i] = lengths[i];
    const float change = static_cast<float>(growth) * spacing.distances[i];
    if (!std::isfinite(change)) continue;  // a piece without a border
    const float there = std::min(spacing.lengths[i], longest * lengths[i]);
    result[i] = std::min(std::max(lengths[i], there - change), there + change);
  }
  return EdgeLength(std::move(result));
}

}  // namespace meshgrain
