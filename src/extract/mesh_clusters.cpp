#include "extract/mesh_clusters.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "extract/link_condition.h"
#include "field/jumps.h"
#include "field/posy.h"

namespace meshgrain {
namespace {

/// The triangles with a jump on every edge, as they shrink.
class Collapse {
 public:
  Collapse(const Mesh& surface, const Graph& graph, const OrientationField& orientation,
           const PositionField& position, PositionEnergy energy, const Context& context)
      : graph_(graph),
        orientation_(orientation),
        position_(position),
        map_(surface, sources_, holes_, context),
        merged_into_(map_.vertices()) {
    std::iota(merged_into_.begin(), merged_into_.end(), Index{0});
    rim_.assign(map_.vertices(), 0);
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (holes_[h]) rim_[map_.origin(h)] = 1;
    }
    jumps_.resize(map_.halfedges() / 2);
    context.for_ranges(jumps_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        const auto h = static_cast<Index>(2 * e);
        jumps_[e] = edge_jump(graph, orientation, position, energy, sources_[map_.origin(h)],
                              sources_[map_.target(h)]);
      }
    });
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
        if (link_.holds(map_, holes_, c.h)) {
          collapse(c.h);
        } else {
          candidates[kept++] = c;
        }
      }
      candidates.resize(kept);
    }
  }

  CollapsedMesh result() &&;

 private:
  Jump jump(Index h) const {
    const Jump& stored = jumps_[h / 2];
    return h % 2 == 0 ? stored : reversed(stored);
  }

  void set_jump(Index h, const Jump& jump) { jumps_[h / 2] = h % 2 == 0 ? jump : reversed(jump); }

  /// The jump back, in the frame of the other end.
  Jump reversed(const Jump& jump) const {
    const auto t = rotate_jump(jump.t, jump.rotation, position_.posy);
    return {(position_.posy - jump.rotation) % position_.posy, {-t[0], -t[1]}};
  }

  /// The jump a -> c by way of b, in the frame of a.
  Jump composed(const Jump& ab, const Jump& bc) const {
    const int posy = position_.posy;
    const auto t = rotate_jump(bc.t, (posy - ab.rotation) % posy, posy);
    return {(ab.rotation + bc.rotation) % posy, {ab.t[0] + t[0], ab.t[1] + t[1]}};
  }

  template <typename Body>
  void for_each_leaving(Index v, const Body& body) const {
    const Index start = map_.leaving(v);
    Index h = start;
    do {
      body(h);
      h = map_.around(h);
    } while (h != start);
  }

  /// How far a jump is from the real distance between two vertices, in edge lengths.
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

  void collapse(Index h) {
    // The smaller star moves.
    const auto valence = [&](Index v) { return map_.valence(v); };
    if (valence(map_.origin(h)) < valence(map_.target(h))) h = PolygonMap::twin(h);
    const Index t = PolygonMap::twin(h), a = map_.origin(h), b = map_.origin(t);
    const Jump ab = jump(h);
    for_each_leaving(b, [&](Index g) {
      if (g != t) set_jump(g, composed(ab, jump(g)));
    });
    // The triangles on both sides lose the edge; of the two others of each one goes. Where their
    // jumps disagree (the triangle is singular), the one that is nearer to the real distance stays.
    const Index next_h = map_.next(h), prev_h = map_.prev(h);
    const Index next_t = map_.next(t), prev_t = map_.prev(t);
    const bool left = !holes_[h], right = !holes_[t];
    struct Zip {
      Index gone, kept;
    };
    const auto choose = [&](Index from_b, Index from_a, Index apex) -> Zip {
      // Halfedges of the two edges, inside the triangle that vanishes.
      const Jump of_b = map_.origin(from_b) == b ? jump(from_b) : jump(PolygonMap::twin(from_b));
      const Jump of_a = map_.origin(from_a) == a ? jump(from_a) : jump(PolygonMap::twin(from_a));
      const bool b_better =
          of_a.t != of_b.t && deviation(a, apex, of_b.t) < deviation(a, apex, of_a.t);
      return b_better ? Zip{from_a, from_b} : Zip{from_b, from_a};
    };
    Zip zips[2];
    int count = 0;
    if (left) zips[count++] = choose(next_h, prev_h, map_.target(next_h));
    if (right) zips[count++] = choose(prev_t, next_t, map_.target(next_t));
    map_.contract_edge(h);
    for (int k = 0; k < count; ++k) {
      holes_[zips[k].kept] = holes_[PolygonMap::twin(zips[k].gone)];
      map_.remove_edge(zips[k].gone);
    }
    merged_into_[b] = a;
  }

  const Graph& graph_;
  const OrientationField& orientation_;
  const PositionField& position_;
  std::vector<Index> sources_;
  std::vector<std::uint8_t> holes_;
  PolygonMap map_;
  std::vector<Jump> jumps_;
  std::vector<Index> merged_into_;
  std::vector<std::uint8_t> rim_;  // for each vertex at the start, whether it was on a border
  LinkCondition link_;
};

/// Members of different clusters that are one vertex of the surface.
std::vector<CollapsedMesh::Meeting> find_meetings(std::span<const Index> sources,
                                                  std::span<const Index> cluster,
                                                  std::size_t surface_vertices) {
  std::vector<Index> first(surface_vertices, no_index);  // member
  std::vector<std::array<Index, 2>> pairs;
  for (Index m = 0; m < sources.size(); ++m) {
    Index& other = first[sources[m]];
    if (other == no_index) {
      other = m;
    } else if (cluster[other] != cluster[m]) {
      pairs.push_back({std::min(cluster[other], cluster[m]), std::max(cluster[other], cluster[m])});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<CollapsedMesh::Meeting> meetings;
  for (std::size_t k = 0; k < pairs.size();) {
    const std::size_t start = k;
    while (k < pairs.size() && pairs[k] == pairs[start]) ++k;
    meetings.push_back({pairs[start][0], pairs[start][1], static_cast<Index>(k - start)});
  }
  return meetings;
}

CollapsedMesh Collapse::result() && {
  const auto vertices = static_cast<Index>(map_.vertices());
  const PolygonMap::Renumbering rank = map_.compact();
  std::vector<Index> cluster(vertices);
  for (Index v = 0; v < vertices; ++v) {
    Index root = v;
    while (merged_into_[root] != root) root = merged_into_[root] = merged_into_[merged_into_[root]];
    cluster[v] = rank.vertices[root];
  }
  std::vector<std::uint8_t> holes(map_.halfedges());
  std::vector<std::array<int, 2>> jumps(map_.halfedges() / 2);
  for (Index e = 0; e < rank.edges.size(); ++e) {
    const Index to = rank.edges[e];
    if (to == no_index) continue;
    holes[2 * to] = holes_[2 * e];
    holes[2 * to + 1] = holes_[2 * e + 1];
    jumps[to] = jumps_[e].t;
  }
  Clusters clusters =
      average_clusters(graph_, position_, sources_, cluster, rim_, rank.vertex_count);
  auto meetings = find_meetings(sources_, cluster, graph_.size());
  return {std::move(map_), std::move(clusters), std::move(holes), std::move(meetings),
          std::move(jumps)};
}

}  // namespace

CollapsedMesh collapse_mesh(const Mesh& surface, const Graph& graph,
                            const OrientationField& orientation, const PositionField& position,
                            PositionEnergy energy, const Context& context) {
  Collapse collapse(surface, graph, orientation, position, energy, context);
  collapse.run(context);
  return std::move(collapse).result();
}

}  // namespace meshgrain
