#include "extract/mesh_clusters.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "features/feature_jumps.h"
#include "field/posy.h"

namespace meshgrain {
namespace {

/// The triangles with a jump on every edge, as they shrink.
class Collapse {
 public:
  Collapse(const Mesh& surface, const FeatureLines& features, const Graph& graph,
           const OrientationField& orientation, const PositionField& position,
           PositionEnergy energy, const Context& context)
      : graph_(graph), orientation_(orientation), position_(position) {
    lattice_.posy = position.posy;
    lattice_.map = PolygonMap(surface, sources_, holes_, context);
    merged_into_.resize(map_.vertices());
    std::iota(merged_into_.begin(), merged_into_.end(), Index{0});
    rim_.assign(map_.vertices(), 0);
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (holes_[h]) rim_[map_.origin(h)] = 1;
    }
    const FeatureEdges edges(features, graph.size());
    lattice_.hold.resize(map_.vertices());
    for (Index v = 0; v < map_.vertices(); ++v) lattice_.hold[v] = edges.hold(sources_[v]);
    hold_ = lattice_.hold;
    jumps_.resize(map_.halfedges() / 2);
    lattice_.lines.resize(map_.halfedges() / 2);
    const FeatureJumps jumps(graph, orientation, position, energy);
    context.for_ranges(jumps_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        const auto h = static_cast<Index>(2 * e);
        const Index i = sources_[map_.origin(h)], j = sources_[map_.target(h)];
        const Index line = lattice_.lines[e] = edges.line(i, j);
        jumps_[e] = jumps.jump(i, j, edges.hold(i), edges.hold(j),
                               line != no_index && features.align[line] > 0);
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

  CollapsedMesh result() &&;

 private:
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

  const Graph& graph_;
  const OrientationField& orientation_;
  const PositionField& position_;
  std::vector<Index> sources_;
  JumpMap lattice_;
  PolygonMap& map_ = lattice_.map;
  std::vector<std::uint8_t>& holes_ = lattice_.holes;
  std::vector<Jump>& jumps_ = lattice_.jumps;
  std::vector<Index> merged_into_;
  // For each vertex at the start, whether it was on a border, and how it was held.
  std::vector<std::uint8_t> rim_, hold_;
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
  Clusters clusters =
      average_clusters(graph_, position_, sources_, cluster, rim_, hold_, rank.vertex_count);
  auto meetings = find_meetings(sources_, cluster, graph_.size());
  return {std::move(lattice_), std::move(clusters), std::move(roots), std::move(meetings)};
}

}  // namespace

CollapsedMesh collapse_mesh(const Mesh& surface, const FeatureLines& features, const Graph& graph,
                            const OrientationField& orientation, const PositionField& position,
                            PositionEnergy energy, const Context& context) {
  Collapse collapse(surface, features, graph, orientation, position, energy, context);
  collapse.run(context);
  return std::move(collapse).result();
}

}  // namespace meshgrain
