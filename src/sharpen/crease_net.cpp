#include "sharpen/crease_net.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "mesh/border.h"
#include "meshgrain/surface.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using Edge = std::array<Index, 2>;

class CreaseNet {
 public:
  /// Rings of up to `ring` are none.
  CreaseNet(const Mesh& mesh, double ring, const Context& context)
      : mesh_(mesh),
        edge_(edge_lengths(mesh).mean),
        ring_(ring),
        neighbors_(mesh.positions.size()) {
    constexpr double all = -1;  // degrees
    for (const SharpEdge& edge : sharp_edges(mesh, all, context)) {
      ways_.push_back({edge.ends[0], edge.ends[1], edge.cosine});
      ways_.push_back({edge.ends[1], edge.ends[0], edge.cosine});
    }
    std::sort(ways_.begin(), ways_.end(), [](const Way& x, const Way& y) {
      return std::tie(x.from, x.to) < std::tie(y.from, y.to);
    });
    first_way_.assign(mesh.positions.size() + 1, 0);
    for (const Way& way : ways_) ++first_way_[way.from + 1];
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) first_way_[v + 1] += first_way_[v];
  }

  /// The sharpest edges first; none that closes a ring of a few: where no edge of the triangles
  /// lies in a crease, there is one on either side of it.
  void add(std::vector<Edge> edges) {
    std::sort(edges.begin(), edges.end(), [&](const Edge& x, const Edge& y) {
      return std::tuple(way(x[0], x[1]).cosine, x) < std::tuple(way(y[0], y[1]).cosine, y);
    });
    for (const auto& [a, b] : edges) {
      if (!are_joined(a, b, ring_)) link(a, b);
    }
  }

  void open_rings() {
    std::vector<Edge> all = edges();
    for (auto& list : neighbors_) list.clear();
    add(std::move(all));
  }

  void bridge_gaps() {
    for (Index v = 0; v < neighbors_.size(); ++v) {
      if (neighbors_[v].size() == 1) bridge(v);
    }
  }

  void drop_twigs(double shortest) {
    for (bool changed = true; changed;) {
      changed = false;
      for (Index v = 0; v < neighbors_.size(); ++v) {
        if (neighbors_[v].size() != 1) continue;
        const std::vector<Index> twig = walk(v);
        const bool alone = neighbors_[twig.back()].size() == 1;
        if (length(twig) >= (alone ? 2 * shortest : shortest)) continue;
        for (std::size_t k = 1; k < twig.size(); ++k) unlink(twig[k - 1], twig[k]);
        changed = true;
      }
    }
  }

  std::vector<Edge> edges() const {
    std::vector<Edge> result;
    for (Index v = 0; v < neighbors_.size(); ++v) {
      for (const Index w : neighbors_[v]) {
        if (v < w) result.push_back({v, w});
      }
    }
    sort_unique(result);
    return result;
  }

 private:
  struct Way {
    Index from, to;
    double cosine;
  };

  bool linked(Index a, Index b) const {
    return std::find(neighbors_[a].begin(), neighbors_[a].end(), b) != neighbors_[a].end();
  }
  void link(Index a, Index b) {
    if (linked(a, b)) return;
    neighbors_[a].push_back(b);
    neighbors_[b].push_back(a);
  }
  void unlink(Index a, Index b) {
    std::erase(neighbors_[a], b);
    std::erase(neighbors_[b], a);
  }
  const Way& way(Index a, Index b) const {
    const auto begin = ways_.begin() + first_way_[a], end = ways_.begin() + first_way_[a + 1];
    return *std::lower_bound(begin, end, b, [](const Way& w, Index to) { return w.to < to; });
  }
  double distance(Index a, Index b) const {
    return (mesh_.positions[a] - mesh_.positions[b]).norm();
  }
  double length(const std::vector<Index>& path) const {
    double sum = 0;
    for (std::size_t k = 1; k < path.size(); ++k) sum += distance(path[k - 1], path[k]);
    return sum;
  }

  /// Whether the net has a way from a to b of at most that length.
  bool are_joined(Index a, Index b, double farthest) const {
    std::map<Index, double> reached{{a, 0}};
    std::vector<Index> open{a};
    while (!open.empty()) {
      const Index v = open.back();
      open.pop_back();
      for (const Index w : neighbors_[v]) {
        const double way = reached[v] + distance(v, w);
        if (way > farthest) continue;
        if (w == b) return true;
        const auto [it, is_new] = reached.emplace(w, way);
        if (!is_new && it->second <= way) continue;
        it->second = way;
        open.push_back(w);
      }
    }
    return false;
  }

  /// From an end to where the line ends or others join.
  std::vector<Index> walk(Index v) const {
    std::vector<Index> path{v, neighbors_[v][0]};
    while (neighbors_[path.back()].size() == 2 && path.back() != v) {
      const auto& next = neighbors_[path.back()];
      path.push_back(next[0] == path[path.size() - 2] ? next[1] : next[0]);
    }
    return path;
  }

  /// Goes on from an end, ahead, to another part of the net if one is near.
  void bridge(Index end) {
    const double farthest = 5 * edge_;
    const std::vector<Index> own = walk(end);
    Index behind = own[0];
    for (std::size_t k = 1; k < own.size() && distance(behind, end) < 2 * edge_; ++k) {
      behind = own[k];
    }
    const Vec3 ahead = mesh_.positions[end] - mesh_.positions[behind];
    std::vector<Index> near;  // of its own line
    double back = 0;
    for (std::size_t k = 0; k < own.size() && back < 2 * farthest; ++k) {
      near.push_back(own[k]);
      if (k + 1 < own.size()) back += distance(own[k], own[k + 1]);
    }
    std::sort(near.begin(), near.end());

    struct Reached {
      double cost;
      Index vertex, from;
      bool operator>(const Reached& o) const {
        return std::tie(cost, vertex) > std::tie(o.cost, o.vertex);
      }
    };
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    std::unordered_map<Index, Index> came_from;
    queue.push({0, end, no_index});
    while (!queue.empty()) {
      const Reached at = queue.top();
      queue.pop();
      if (at.cost > farthest) return;
      if (!came_from.emplace(at.vertex, at.from).second) continue;
      const bool is_own = std::binary_search(near.begin(), near.end(), at.vertex);
      if (!neighbors_[at.vertex].empty() && !is_own) {
        for (Index v = at.vertex; v != end; v = came_from[v]) link(v, came_from[v]);
        return;
      }
      if (is_own && at.vertex != end) continue;
      for (Index w = first_way_[at.vertex]; w < first_way_[at.vertex + 1]; ++w) {
        const Vec3 d = mesh_.positions[ways_[w].to] - mesh_.positions[end];
        constexpr float cos60 = 0.5f;
        if (d.dot(ahead) < cos60 * d.norm() * ahead.norm()) continue;
        // Along what is nearly a crease rather than across a flat part.
        constexpr double sharp = 40 * std::numbers::pi / 180;
        const double angle = std::acos(std::clamp(ways_[w].cosine, -1.0, 1.0));
        const double step = distance(at.vertex, ways_[w].to) * (2 - std::min(1.0, angle / sharp));
        queue.push({at.cost + step, ways_[w].to, at.vertex});
      }
    }
  }

  const Mesh& mesh_;
  double edge_;
  double ring_;  // length of rings that are none
  std::vector<std::vector<Index>> neighbors_;
  std::vector<Way> ways_;  // sorted
  std::vector<Index> first_way_;
};

}  // namespace

std::vector<Edge> connect_creases(const Mesh& triangles, const std::vector<Edge>& edges,
                                  double shortest, const Context& context) {
  const double ring = std::max(12 * edge_lengths(triangles).mean, 3.5 * shortest);
  CreaseNet net(triangles, ring, context);
  net.add(edges);
  net.bridge_gaps();
  net.open_rings();
  net.drop_twigs(shortest);
  return net.edges();
}

std::vector<Edge> drop_scraps(const Mesh& triangles, const std::vector<Edge>& edges,
                              double shortest, const Context& context) {
  constexpr double around_a_vertex = 6;  // edges
  const double ring = around_a_vertex * edge_lengths(triangles).mean;
  CreaseNet net(triangles, ring, context);
  net.add(edges);
  net.drop_twigs(shortest);
  return net.edges();
}

}  // namespace meshgrain
