#include "finish/bare_ends.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "graph/spread.h"
#include "util/collect.h"
#include "util/radix_sort.h"
#include "util/sort_unique.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

/// The vertex nearest to a point among one of the mesh and its neighbours.
Index nearest_around(const Vec3& p, const Mesh& mesh, const VertexFaces& around, Index vertex) {
  float best = (p - mesh.positions[vertex]).squaredNorm();
  for (const Index f : around[vertex]) {
    for (const Index v : mesh.faces[f]) {
      const float distance = (p - mesh.positions[v]).squaredNorm();
      if (distance >= best) continue;
      best = distance;
      vertex = v;
    }
  }
  return vertex;
}

/// The one to which none of its neighbours is nearer, on the way from `vertex`, or the first on
/// this way that will do.
template <typename WillDo>
Index walk_to_nearest(const Vec3& p, const Mesh& mesh, const VertexFaces& around, Index vertex,
                      const WillDo& will_do) {
  while (!will_do(vertex)) {
    const Index next = nearest_around(p, mesh, around, vertex);
    if (next == vertex) break;
    vertex = next;
  }
  return vertex;
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

class BareEnds {
 public:
  BareEnds(const Extraction& extraction, const VertexFaces& around, const Graph& graph,
           const Context& context)
      : extraction_(extraction),
        around_(around),
        graph_(graph),
        context_(context),
        vertex_(graph.size(), no_index) {}

  std::vector<Reach> find(const EdgeLength& reach);
  std::vector<Index> nodes(const EdgeLength& reach);

 private:
  /// The nodes that have no vertex within reach on their side of the surface.
  std::vector<Index> not_reached(const EdgeLength& reach);
  void find_ways(const std::vector<Index>& bare);
  /// Whether there is a way, and longer than `reach`.
  bool is_far(Index node, const EdgeLength& reach) const {
    return length_[node] > reach[node] && length_[node] < std::numeric_limits<float>::infinity();
  }
  float distance_to_mesh(Index node) const {
    return distance_to_star(graph_.positions[node], extraction_.mesh, around_, vertex_[node]);
  }

  const Extraction& extraction_;
  const VertexFaces& around_;
  const Graph& graph_;
  const Context& context_;
  // Of each node:
  std::vector<Index> vertex_;  // one that reaches it; of those to which ways go the nearest
  std::vector<float> length_;  // of the way; 0 where none is needed
  std::vector<Index> before_;  // the node before on the way, or no_index
};

std::vector<Index> BareEnds::not_reached(const EdgeLength& reach) {
  const std::vector<Vec3>& positions = extraction_.mesh.positions;
  // Nodes, in the upper bits, and their vertices.
  std::vector<std::uint64_t> places(positions.size());
  for (Index v = 0; v < positions.size(); ++v) {
    places[v] = (std::uint64_t{extraction_.nodes[v]} << 32) | v;
  }
  radix_sort_by_upper(places, static_cast<int>(std::bit_width(graph_.size())), context_);
  const auto node_of = [](std::uint64_t place) { return static_cast<Index>(place >> 32); };
  const auto vertex_of = [](std::uint64_t place) { return static_cast<Index>(place); };
  return collect<Index>(
      vertex_.size(),
      [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        auto after = std::ranges::lower_bound(places, std::uint64_t{begin} << 32);
        Index before = no_index;  // the vertex that reaches the node before
        for (auto i = static_cast<Index>(begin); i < end; ++i) {
          while (after != places.end() && node_of(*after) < i) ++after;
          const Vec3& p = graph_.positions[i];
          const auto is_reached = [&](Index v) {
            if ((p - positions[v]).squaredNorm() > reach[i] * reach[i]) return false;
            if (graph_.normals[i].dot(graph_.normals[extraction_.nodes[v]]) <= 0) return false;
            before = vertex_[i] = v;
            return true;
          };
          const auto is_reached_from = [&](Index v) {
            return is_reached(walk_to_nearest(p, extraction_.mesh, around_, v, is_reached));
          };
          // From that of the node before, else from those with the nodes just after and before:
          // near in a space-filling order, near in space.
          if (before != no_index && is_reached_from(before)) continue;
          if (after != places.end() && is_reached_from(vertex_of(*after))) continue;
          if (after != places.begin() && is_reached_from(vertex_of(*std::prev(after)))) continue;
          found.push_back(i);
          before = no_index;
        }
      },
      context_);
}

/// Ways over the graph to the nodes that no vertex reaches, from those beside them.
void BareEnds::find_ways(const std::vector<Index>& bare) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  length_.assign(graph_.size(), 0);
  before_.assign(graph_.size(), no_index);
  for (const Index i : bare) length_[i] = infinity;
  std::vector<Index> beside;
  for (const Index i : bare) {
    for (const Index j : graph_.neighbors_of(i)) {
      if (length_[j] == 0) beside.push_back(j);
    }
  }
  sort_unique(beside);
  std::vector<std::pair<float, Index>> sources;
  for (const Index i : beside) {
    const Vec3& p = graph_.positions[i];
    vertex_[i] =
        walk_to_nearest(p, extraction_.mesh, around_, vertex_[i], [](Index) { return false; });
    length_[i] = (p - extraction_.mesh.positions[vertex_[i]]).norm();
    sources.push_back({length_[i], i});
  }
  const auto lower = [&](Index i, Index j) {
    const float farther = length_[i] + (graph_.positions[j] - graph_.positions[i]).norm();
    if (farther >= length_[j]) return false;
    length_[j] = farther;
    vertex_[j] = vertex_[i];
    before_[j] = i;
    return true;
  };
  spread(graph_, length_, sources, 1, lower, context_);
}

std::vector<Reach> BareEnds::find(const EdgeLength& reach) {
  const std::vector<Index> bare = not_reached(reach);
  if (bare.empty()) return {};
  find_ways(bare);
  struct Tip {
    float distance;
    Index node;
  };
  std::vector<Tip> tips;
  for (const Index i : bare) {
    if (!is_far(i, reach)) continue;
    const auto neighbors = graph_.neighbors_of(i);
    if (std::any_of(neighbors.begin(), neighbors.end(),
                    [&](Index j) { return length_[j] > length_[i]; })) {
      continue;
    }
    const float distance = distance_to_mesh(i);
    if (distance > reach[i]) tips.push_back({distance, i});
  }
  std::sort(tips.begin(), tips.end(), [](const Tip& a, const Tip& b) {
    return std::pair(b.distance, a.node) < std::pair(a.distance, b.node);
  });
  std::vector<Reach> result;
  for (const Tip& tip : tips) {
    const Vec3& end = graph_.positions[tip.node];
    const float radius = reach[tip.node];
    // A vertex can hold only one end: the one farthest away.
    if (std::ranges::any_of(result, [&](const Reach& other) {
          return other.vertex == vertex_[tip.node] || (end - other.tip).norm() < 2 * radius;
        })) {
      continue;
    }
    // Back from the tip until it is far enough.
    const auto distance = [&](Index i) { return (graph_.positions[i] - end).norm(); };
    Index node = tip.node, outer = tip.node;
    while (distance(node) < radius && before_[node] != no_index) {
      outer = std::exchange(node, before_[node]);
    }
    const float under = distance(node) - radius, over = radius - distance(outer);
    const float share = under > 0 ? under / (under + over) : 0.0f;
    result.push_back(
        {vertex_[tip.node], share < 0.5f ? node : outer,
         graph_.positions[node] + share * (graph_.positions[outer] - graph_.positions[node]), end,
         radius});
  }
  return result;
}

std::vector<Index> BareEnds::nodes(const EdgeLength& reach) {
  constexpr float share = 0.75f;  // in the middle of a square face vertices are .7 of a side away
  std::vector<Index> bare = not_reached(reach);
  if (bare.empty()) return {};
  find_ways(bare);
  std::erase_if(
      bare, [&](Index i) { return !is_far(i, reach) || distance_to_mesh(i) <= share * reach[i]; });
  return bare;
}

}  // namespace

std::vector<Reach> find_bare_ends(const Extraction& extraction, const VertexFaces& around,
                                  const Graph& graph, const EdgeLength& reach,
                                  const Context& context) {
  return BareEnds(extraction, around, graph, context).find(reach);
}

std::vector<Index> find_bare_nodes(const Extraction& extraction, const VertexFaces& around,
                                   const Graph& graph, const EdgeLength& reach,
                                   const Context& context) {
  return BareEnds(extraction, around, graph, context).nodes(reach);
}

}  // namespace meshgrain
