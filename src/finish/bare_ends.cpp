#include "finish/bare_ends.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include "graph/spread.h"
#include "util/collect.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

/// The nodes of a graph by their way to the nearest vertex of a mesh.
struct Ways {
  std::vector<float> length;
  std::vector<Index> vertex;  // the nearest
  std::vector<Index> before;  // the node before on the way from there, or no_index
};

/// The vertex of the mesh to which none of its neighbours is nearer, on the way from `vertex`.
Index walk_to_nearest(const Vec3& p, const Mesh& mesh, const VertexFaces& around, Index vertex) {
  float best = (p - mesh.positions[vertex]).squaredNorm();
  for (Index from = no_index; from != vertex;) {
    from = vertex;
    for (const Index f : around[from]) {
      for (const Index v : mesh.faces[f]) {
        const float distance = (p - mesh.positions[v]).squaredNorm();
        if (distance >= best) continue;
        best = distance;
        vertex = v;
      }
    }
  }
  return vertex;
}

/// Straight ways of the nodes that have a vertex within reach on their side of the surface, not yet
/// the nearest. It is looked for from where the node before found its own, else from the vertices
/// with the nodes just before and after: near in a space-filling order, near in space.
Ways straight_ways(const Extraction& extraction, const VertexFaces& around, const Graph& graph,
                   const EdgeLength& reach, const Context& context) {
  const std::size_t n = graph.size();
  Ways ways{std::vector<float>(n, std::numeric_limits<float>::infinity()),
            std::vector<Index>(n, no_index), std::vector<Index>(n, no_index)};
  struct Place {
    Index node, vertex;
    bool operator<(const Place& o) const {
      return std::tie(node, vertex) < std::tie(o.node, o.vertex);
    }
  };
  std::vector<Place> places;
  for (Index v = 0; v < extraction.nodes.size(); ++v) places.push_back({extraction.nodes[v], v});
  std::sort(places.begin(), places.end());
  if (places.empty()) return ways;
  constexpr std::size_t grain = 4096;
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    auto after =
        std::lower_bound(places.begin(), places.end(), Place{static_cast<Index>(begin), 0});
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      while (after != places.end() && after->node < i) ++after;
      const Vec3& p = graph.positions[i];
      const auto is_reached = [&](Index v) {
        const float length = (p - extraction.mesh.positions[v]).norm();
        if (length > reach[i]) return false;
        if (graph.normals[i].dot(graph.normals[extraction.nodes[v]]) <= 0) return false;
        ways.length[i] = length;
        ways.vertex[i] = v;
        return true;
      };
      const auto reached_from = [&](Index start) {
        return is_reached(start) || is_reached(walk_to_nearest(p, extraction.mesh, around, start));
      };
      if (i > begin && ways.vertex[i - 1] != no_index && reached_from(ways.vertex[i - 1])) continue;
      if (after != places.end() && reached_from(after->vertex)) continue;
      if (after != places.begin()) reached_from(std::prev(after)->vertex);
    }
  });
  return ways;
}

/// Goes on over the graph to the nodes that no vertex reaches, from those beside them.
void go_on(Ways& ways, const Extraction& extraction, const VertexFaces& around, const Graph& graph,
           const Context& context) {
  const auto beside = collect<Index>(
      graph.size(),
      [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        for (auto i = static_cast<Index>(begin); i < end; ++i) {
          if (ways.vertex[i] == no_index) continue;
          const auto neighbors = graph.neighbors_of(i);
          if (std::any_of(neighbors.begin(), neighbors.end(),
                          [&](Index j) { return ways.vertex[j] == no_index; })) {
            found.push_back(i);
          }
        }
      },
      context);
  std::vector<std::pair<float, Index>> sources;
  for (const Index i : beside) {
    const Vec3& p = graph.positions[i];
    ways.vertex[i] = walk_to_nearest(p, extraction.mesh, around, ways.vertex[i]);
    ways.length[i] = (p - extraction.mesh.positions[ways.vertex[i]]).norm();
    sources.push_back({ways.length[i], i});
  }
  const auto lower = [&](Index i, Index j) {
    const float farther = ways.length[i] + (graph.positions[j] - graph.positions[i]).norm();
    if (farther >= ways.length[j]) return false;
    ways.length[j] = farther;
    ways.vertex[j] = ways.vertex[i];
    ways.before[j] = i;
    return true;
  };
  spread(graph, ways.length, sources, 1, lower, context);
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
  Ways ways = straight_ways(extraction, around, graph, reach, context);
  go_on(ways, extraction, around, graph, context);
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
  for (const Tip& tip : tips) {
    const Vec3& end = graph.positions[tip.node];
    const float radius = reach[tip.node];
    // A vertex can hold only one end: the one farthest away.
    if (std::ranges::any_of(result, [&](const Reach& other) {
          return other.vertex == ways.vertex[tip.node] || (end - other.tip).norm() < 2 * radius;
        })) {
      continue;
    }
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
