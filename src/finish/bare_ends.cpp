#include "finish/bare_ends.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "graph/spread.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

/// The nodes of a graph by their way to the nearest vertex of a mesh.
struct Ways {
  std::vector<float> length;
  std::vector<Index> vertex;  // the nearest
  std::vector<Index> before;  // the node before on the way from there, or no_index
};

Ways ways_from_vertices(const Extraction& extraction, const Graph& graph, const Context& context) {
  const std::size_t n = graph.size();
  Ways ways{std::vector<float>(n, std::numeric_limits<float>::infinity()),
            std::vector<Index>(n, no_index), std::vector<Index>(n, no_index)};
  std::vector<std::pair<float, Index>> sources;
  const auto reach = [&](Index node, float length, Index vertex, Index before) {
    if (length >= ways.length[node]) return false;
    ways.length[node] = length;
    ways.vertex[node] = vertex;
    ways.before[node] = before;
    return true;
  };
  for (Index v = 0; v < extraction.nodes.size(); ++v) {
    const Index node = extraction.nodes[v];
    const float length = (extraction.mesh.positions[v] - graph.positions[node]).norm();
    if (reach(node, length, v, no_index)) sources.push_back({length, node});
  }
  const auto go_on = [&](Index i, Index j) {
    const float farther = ways.length[i] + (graph.positions[j] - graph.positions[i]).norm();
    return reach(j, farther, ways.vertex[i], i);
  };
  spread(graph, ways.length, sources, 1, go_on, context);
  return ways;
}

/// The distance from a point to the faces around a vertex and its neighbours.
float distance_to_star(const Vec3& p, const Mesh& mesh, const VertexFaces& around, Index vertex) {
  float least = (p - mesh.positions[vertex]).squaredNorm();
  for (const Index f : around[vertex]) {
    for (const Index v : mesh.faces[f]) {
      for (const Index g : around[v]) {
        const auto face = mesh.faces[g];
        for (std::size_t k = 2; k < face.size(); ++k) {
          const Vec3 q = closest_point_on_triangle(
              p, mesh.positions[face[0]], mesh.positions[face[k - 1]], mesh.positions[face[k]]);
          least = std::min(least, (p - q).squaredNorm());
        }
      }
    }
  }
  return std::sqrt(least);
}

}  // namespace

std::vector<Reach> find_bare_ends(const Extraction& extraction, const VertexFaces& around,
                                  const Graph& graph, const EdgeLength& reach,
                                  const Context& context) {
  const Ways ways = ways_from_vertices(extraction, graph, context);
  struct Tip {
    float distance;
    Index node;
  };
  std::vector<Tip> tips;
  for (Index i = 0; i < graph.size(); ++i) {
    if (!(ways.length[i] > reach[i]) || ways.vertex[i] == no_index) continue;
    const auto neighbors = graph.neighbors_of(i);
    if (std::any_of(neighbors.begin(), neighbors.end(),
                    [&](Index j) { return ways.length[j] > ways.length[i]; })) {
      continue;
    }
    const float distance =
        distance_to_star(graph.positions[i], extraction.mesh, around, ways.vertex[i]);
    if (distance > reach[i]) tips.push_back({distance, i});
  }
  std::sort(tips.begin(), tips.end(), [](const Tip& a, const Tip& b) {
    return std::pair(b.distance, a.node) < std::pair(a.distance, b.node);
  });
  std::vector<Reach> result;
  std::vector<Vec3> taken;
  for (const Tip& tip : tips) {
    const Vec3& end = graph.positions[tip.node];
    const float radius = reach[tip.node];
    if (std::any_of(taken.begin(), taken.end(),
                    [&](const Vec3& other) { return (end - other).norm() < 2 * radius; })) {
      continue;
    }
    taken.push_back(end);
    // Back from the tip until it is far enough.
    const auto distance = [&](Index i) { return (graph.positions[i] - end).norm(); };
    Index node = tip.node, outer = tip.node;
    while (distance(node) < radius && ways.before[node] != no_index) {
      outer = std::exchange(node, ways.before[node]);
    }
    const float under = distance(node) - radius, over = radius - distance(outer);
    const float share = under > 0 ? under / (under + over) : 0.0f;
    result.push_back(
        {ways.vertex[tip.node], share < 0.5f ? node : outer,
         graph.positions[node] + share * (graph.positions[outer] - graph.positions[node]), end,
         radius});
  }
  return result;
}

}  // namespace meshgrain
