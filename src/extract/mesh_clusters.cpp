#include "extract/mesh_clusters.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "extract/disk_clusters.h"
#include "features/feature_jumps.h"
#include "field/posy.h"
#include "mesh/border.h"
#include "util/collect.h"
#include "util/edge_of.h"
#include "util/indices.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

/// The triangles with a jump on every edge, as they shrink.
class Collapse {
 public:
  Collapse(const Mesh& surface, const FeatureLines& features, const Graph& graph,
           const OrientationField& orientation, const PositionField& position,
           PositionEnergy energy, const Context& context)
      : graph_(graph), orientation_(orientation), position_(position) {
    const FeatureEdges edges(features, graph.size());
    hold_ = edges.holds();
    std::vector<std::uint8_t> is_free(graph.size());
    for_indices(
        graph.size(), [&](Index i) { is_free[i] = hold_[i] == free_vertex; }, context);
    disks_ = find_disk_clusters(surface, graph, orientation, position, energy, std::move(is_free),
                                context);
    lattice_.posy = position.posy;
    const std::vector<Index> corners = shrink_disks(context);
    const auto halfedges = static_cast<Index>(map_.halfedges());
    merged_into_.resize(map_.vertices());
    std::iota(merged_into_.begin(), merged_into_.end(), Index{0});
    holes_.resize(halfedges);
    rim_.assign(graph.size(), 0);
    hold_touching_pieces(surface, context);
    lattice_.hold.resize(map_.vertices());
    for_indices(
        map_.vertices(), [&](Index v) { lattice_.hold[v] = hold_[sources_[v]]; }, context);
    const auto look_for_hole = [&](Index h) {
      holes_[h] = corners[h] == no_index;
      if (!holes_[h]) return;
      std::atomic_ref(rim_[sources_[map_.origin(h)]]).store(1, std::memory_order_relaxed);
    };
    for_indices(halfedges, look_for_hole, context);
    jumps_.resize(halfedges / 2);
    lattice_.lines.resize(halfedges / 2);
    take_jumps(features, edges, FeatureJumps(graph, orientation, position, energy, hold_), corners,
               context);
  }

  void run(const Context& context) {
    struct Candidate {
      float distance;
      Index h;
      bool operator<(const Candidate& o) const {
        return std::tie(distance, h) < std::tie(o.distance, o.h);
      }
    };
    std::vector<Candidate> candidates;
    for (Index e = 0; e < jumps_.size(); ++e) {
      if (!jumps_[e].is_zero()) continue;
      const Vec3& a = position_.points[sources_[map_.origin(2 * e)]];
      const Vec3& b = position_.points[sources_[map_.target(2 * e)]];
      candidates.push_back({(a - b).norm(), 2 * e});
    }
    context.run([&] { tbb::parallel_sort(candidates); });
    // What the link condition forbids now it may allow later, when more has shrunk around.
    for (std::size_t before = candidates.size() + 1; candidates.size() < before;) {
      before = candidates.size();
      std::size_t kept = 0, done = 0;
      for (const Candidate& c : candidates) {
        if ((++done & 0xffff) == 0) {
          context.progress("extraction", static_cast<double>(done) / static_cast<double>(before));
        }
        if (map_.removed(c.h) || !jumps_[c.h / 2].is_zero()) continue;
        const Index h = inwards(c.h);
        if (lattice_.keeps_features(h) && link_.holds(map_, holes_, h)) {
          collapse(h);
        } else {
          candidates[kept++] = c;
        }
      }
      candidates.resize(kept);
    }
  }

  CollapsedMesh result(const Mesh& surface, std::span<const Index> sources,
                       const Context& context) &&;

 private:
  /// Pieces that touch at a vertex alone would come apart if that vanished: of each two of them the
  /// first stays, as a corner.
  void hold_touching_pieces(const Mesh& surface, const Context& context) {
    if (!any_touch_) return;
    std::vector<Index> first(graph_.size(), no_index);  // vertex of the map
    std::vector<std::array<Index, 2>> touching;
    for (Index v = 0; v < map_.vertices(); ++v) {
      Index& other = first[sources_[v]];
      if (other == no_index) other = v;
      if (other != v) touching.push_back({other, v});
    }
    UnionFind pieces(map_.vertices());
    for (Index h = 0; h < map_.halfedges(); h += 2) pieces.unite(map_.origin(h), map_.target(h));
    const auto on_edge = mark_ends(branch_edges(surface, context), surface.positions.size());
    std::set<std::array<Index, 2>> seen;
    for (const auto& [v, w] : touching) {
      if (on_edge[sources_[v]] != 0) continue;
      const auto pair = edge_of(pieces.find(v), pieces.find(w));
      if (pair[0] != pair[1] && seen.insert(pair).second) hold_[sources_[v]] = at_corner;
    }
  }

  /// The map of the surface with each disk as one vertex, in the frame of its root. Returns the
  /// corners of `disks_.triangles` where halfedges start.
  std::vector<Index> shrink_disks(const Context& context) {
    std::vector<Index> number(graph_.size(), no_index);
    const auto mark_roots = [&](Index t) {
      for (const Index v : disks_.triangles[t]) {
        std::atomic_ref(number[disks_.root[v]]).store(0, std::memory_order_relaxed);
      }
    };
    for_indices(disks_.triangles.size(), mark_roots, context);
    const std::vector<Index> roots = indices_where(
        graph_.size(), [&](Index i) { return number[i] != no_index; }, context);
    for_indices(
        roots.size(), [&](Index k) { number[roots[k]] = k; }, context);
    Mesh shrunk;
    shrunk.positions.resize(roots.size());
    shrunk.faces = Faces::uniform(disks_.triangles.size(), 3);
    Index* const corner = shrunk.faces.corners().data();
    const auto shrink = [&](Index t) {
      for (std::size_t k = 0; k < 3; ++k) {
        corner[3 * t + k] = number[disks_.root[disks_.triangles[t][k]]];
      }
    };
    for_indices(disks_.triangles.size(), shrink, context);
    std::vector<Index> corners;
    map_ = PolygonMap(shrunk, sources_, corners, context);
    any_touch_ = map_.vertices() > roots.size();
    for (Index& source : sources_) source = roots[source];
    return corners;
  }

  /// Gives each edge of the map the jump of an edge of the surface between its two clusters. These
  /// may disagree: where it is far from the real distance of the roots, the nearest one of all.
  void take_jumps(const FeatureLines& features, const FeatureEdges& edges,
                  const FeatureJumps& jumps, const std::vector<Index>& corners,
                  const Context& context) {
    // At least one is in a triangle beside it. Lines run between vertices that are alone.
    context.for_ranges(jumps_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      std::vector<std::array<Index, 2>> found;
      for (std::size_t e = begin; e < end; ++e) {
        const auto h = static_cast<Index>(2 * e);
        const Index corner = corners[h] != no_index ? corners[h] : corners[PolygonMap::twin(h)];
        const auto& triangle = disks_.triangles[corner / 3];
        Index i = triangle[corner % 3], j = triangle[(corner + 1) % 3];
        if (disks_.root[i] != sources_[map_.origin(h)]) std::swap(i, j);
        found.push_back({i, j});
      }
      const std::vector<Jump> own = jumps.jumps(found);
      for (std::size_t e = begin; e < end; ++e) {
        const auto [i, j] = found[e - begin];
        const Index line = lattice_.lines[e] = edges.line(i, j);
        const bool is_aligned = line != no_index && features.align[line] > 0;
        const Jump& jump = own[e - begin];
        jumps_[e] = disks_.between_roots(i, j, is_aligned ? jumps.aligned({i, j}, jump) : jump);
      }
    });
    take_nearest_jumps(jumps, context);
  }

  void take_nearest_jumps(const FeatureJumps& jumps, const Context& context) {
    constexpr float near_enough = 0.45f;  // edge lengths: any other jump would be farther off
    const auto is_near = [&](Index h) {
      const Index a = map_.origin(h), b = map_.target(h);
      const Jump jump = lattice_.jump(h);
      if (jump.t == std::array<int, 2>{0, 0}) return false;  // by any rotation
      return deviation(a, b, jump.t) < near_enough * position_.edge_length[sources_[a]];
    };
    const auto is_far = [&](Index e) { return !is_near(2 * e) || !is_near(2 * e + 1); };
    const std::vector<Index> far = indices_where(jumps_.size(), is_far, context);
    // Of each root that is one vertex, if it has such an edge.
    std::vector<Index> vertex(graph_.size(), no_index);
    for (const Index e : far) {
      for (const Index h : {2 * e, 2 * e + 1}) vertex[sources_[map_.origin(h)]] = map_.origin(h);
    }
    for (Index v = 0; v < map_.vertices(); ++v) {
      Index& other = vertex[sources_[v]];
      if (other != no_index && other != v) other = cut;
    }
    struct Found {
      Index edge;
      float deviation;
      Jump jump;
    };
    const auto look = [&](std::size_t begin, std::size_t end, std::vector<Found>& out) {
      std::vector<std::array<Index, 2>> found;
      std::vector<Index> halfedges;
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        const Index a = vertex[disks_.root[i]];
        if (a >= cut) continue;
        for (const Index j : graph_.neighbors_of(i)) {
          if (j < i || disks_.root[j] == disks_.root[i]) continue;
          // Alone, both have no other edge.
          if (disks_.root[i] == i && disks_.root[j] == j) continue;
          const Index b = vertex[disks_.root[j]];
          const Index h = b < cut ? map_.halfedge(a, b) : no_index;
          if (h == no_index) continue;
          found.push_back({i, j});
          halfedges.push_back(h);
        }
      }
      const std::vector<Jump> own = jumps.jumps(found);
      for (std::size_t k = 0; k < found.size(); ++k) {
        const auto [i, j] = found[k];
        const Index h = halfedges[k];
        const Jump jump = disks_.between_roots(i, j, own[k]);
        out.push_back({h / 2, deviation(map_.origin(h), map_.target(h), jump.t),
                       h % 2 == 0 ? jump : reversed(jump, lattice_.posy)});
      }
    };
    std::vector<float> least(jumps_.size(), std::numeric_limits<float>::infinity());
    for (const Found& other : collect<Found>(graph_.size(), look, context)) {
      if (!(other.deviation < least[other.edge])) continue;
      least[other.edge] = other.deviation;
      jumps_[other.edge] = other.jump;
    }
  }

  /// How far a jump is from the real distance between two vertices.
  float deviation(Index from, Index to, const std::array<int, 2>& t) const {
    const Index i = sources_[from], j = sources_[to];
    const auto point = [&]<int S>() {
      return PoSy<S>(position_.points[i], orientation_.directions[i], graph_.normals[i],
                     position_.edge_length[i])
          .point(t);
    };
    const Vec3 p =
        position_.posy == 4 ? point.template operator()<4>() : point.template operator()<6>();
    return (p - position_.points[j]).norm();
  }

  /// The side of h whose target is the one to vanish: who is less held, or has the smaller star.
  Index inwards(Index h) const {
    const Index a = map_.origin(h), b = map_.target(h);
    const int held = lattice_.hold[a] - lattice_.hold[b];
    const bool stays = held != 0 ? held > 0 : map_.valence(a) >= map_.valence(b);
    return stays ? h : PolygonMap::twin(h);
  }

  void collapse(Index h) {
    const Index a = map_.origin(h), b = map_.target(h);
    lattice_.collapse(h, [&](Index from, Index to, const Jump& x, const Jump& y) {
      return deviation(from, to, x.t) < deviation(from, to, y.t);
    });
    merged_into_[b] = a;
  }

  static constexpr Index cut = no_index - 1;  // instead of a vertex: there are several

  const Graph& graph_;
  const OrientationField& orientation_;
  const PositionField& position_;
  DiskClusters disks_;
  std::vector<Index> sources_;  // of each vertex of the map: the one of the surface
  bool any_touch_ = false;      // several are one of the surface
  JumpMap lattice_;
  PolygonMap& map_ = lattice_.map;
  std::vector<std::uint8_t>& holes_ = lattice_.holes;
  std::vector<Jump>& jumps_ = lattice_.jumps;
  std::vector<Index> merged_into_;
  // Of each vertex of the surface: whether it is on a border, and how it is held.
  std::vector<std::uint8_t> rim_, hold_;
  LinkCondition link_;
};

/// Whether each vertex of a surface is on an edge at which it is cut, or was before.
std::vector<std::uint8_t> on_cut_edges(const Mesh& surface, std::span<const Index> sources,
                                       const Context& context) {
  auto result = mark_ends(branch_edges(surface, context), surface.positions.size());
  for (std::size_t v = 0; v < sources.size(); ++v) {
    if (sources[v] != v) result[sources[v]] = 1;
  }
  return result;
}

/// Members of different clusters that are one vertex of the surface, or were (`before`, if any).
std::vector<CollapsedMesh::Meeting> find_meetings(const Mesh& surface,
                                                  std::span<const Index> before,
                                                  std::span<const Index> sources,
                                                  std::span<const Index> cluster,
                                                  const Context& context) {
  struct Pair {
    Index a, b, source;
    auto operator<=>(const Pair&) const = default;
  };
  // Each meets the first and the one before it: all others, where thousands are, would take long.
  std::vector<Index> first(surface.positions.size(), no_index), last = first;  // members
  std::vector<Pair> pairs;
  const auto source_of = [&](Index member) {
    return before.empty() ? sources[member] : before[sources[member]];
  };
  const auto meet = [&](Index one, Index other) {
    if (cluster[one] == cluster[other]) return;
    const auto [a, b] = std::minmax({cluster[one], cluster[other]});
    pairs.push_back({a, b, source_of(one)});
  };
  for (Index m = 0; m < sources.size(); ++m) {
    const Index source = source_of(m);
    const Index previous = std::exchange(last[source], m);
    if (previous == no_index) {
      first[source] = m;
      continue;
    }
    meet(m, first[source]);
    if (previous != first[source]) meet(m, previous);
  }
  if (pairs.empty()) return {};
  std::sort(pairs.begin(), pairs.end());
  const std::vector<std::uint8_t> on_edge = on_cut_edges(surface, before, context);
  std::vector<CollapsedMesh::Meeting> meetings;
  for (const auto& [a, b, source] : pairs) {
    if (meetings.empty() || meetings.back().a != a || meetings.back().b != b) {
      meetings.push_back({a, b, 0, false});
    }
    ++meetings.back().count;
    meetings.back().along_edge |= on_edge[source] != 0;
  }
  return meetings;
}

CollapsedMesh Collapse::result(const Mesh& surface, std::span<const Index> sources,
                               const Context& context) && {
  const auto vertices = static_cast<Index>(map_.vertices());
  const PolygonMap::Renumbering rank = map_.compact();
  std::vector<Index> cluster(vertices), cluster_of_root(graph_.size(), no_index);
  for (Index v = 0; v < vertices; ++v) {
    Index root = v;
    while (merged_into_[root] != root) root = merged_into_[root] = merged_into_[merged_into_[root]];
    cluster[v] = rank.vertices[root];
    cluster_of_root[sources_[v]] = cluster[v];
  }
  std::vector<Index> roots(rank.vertex_count);
  for (Index v = 0; v < vertices; ++v) {
    const Index to = rank.vertices[v];  // a lower place, in order
    if (to == no_index) continue;
    roots[to] = sources_[v];
    lattice_.hold[to] = lattice_.hold[v];
  }
  lattice_.hold.resize(rank.vertex_count);
  for (Index e = 0; e < rank.edges.size(); ++e) {  // to lower places, in order
    const Index to = rank.edges[e];
    if (to == no_index) continue;
    holes_[2 * to] = holes_[2 * e];
    holes_[2 * to + 1] = holes_[2 * e + 1];
    jumps_[to] = jumps_[e];
    lattice_.lines[to] = lattice_.lines[e];
  }
  holes_.resize(map_.halfedges());
  holes_.shrink_to_fit();
  jumps_.resize(map_.halfedges() / 2);
  jumps_.shrink_to_fit();
  lattice_.lines.resize(jumps_.size());
  auto meetings = find_meetings(surface, sources, sources_, cluster, context);
  // The members of disks, besides their roots.
  std::vector<Index> members = std::move(sources_);
  for (Index i = 0; i < graph_.size(); ++i) {
    if (disks_.root[i] == i) continue;
    members.push_back(i);
    cluster.push_back(cluster_of_root[disks_.root[i]]);
  }
  Clusters clusters = average_clusters(graph_, position_, members, cluster, rim_, hold_,
                                       rank.vertex_count, context);
  return {std::move(lattice_), std::move(clusters), std::move(roots), std::move(meetings)};
}

}  // namespace

CollapsedMesh collapse_mesh(const Mesh& surface, std::span<const Index> sources,
                            const FeatureLines& features, const Graph& graph,
                            const OrientationField& orientation, const PositionField& position,
                            PositionEnergy energy, const Context& context) {
  Collapse collapse(surface, features, graph, orientation, position, energy, context);
  collapse.run(context);
  return std::move(collapse).result(surface, sources, context);
}

}  // namespace meshgrain
