#include "extract/mesh_clusters.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <tuple>

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
        lattice_{position.posy, {}, {}, {}} {
    lattice_.map = PolygonMap(surface, sources_, holes_, context);
    merged_into_.resize(map_.vertices());
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
  std::vector<Index> roots(rank.vertex_count);
  for (Index v = 0; v < vertices; ++v) {
    if (rank.vertices[v] != no_index) roots[rank.vertices[v]] = sources_[v];
  }
  for (Index e = 0; e < rank.edges.size(); ++e) {  // to lower places, in order
    const Index to = rank.edges[e];
    if (to == no_index) continue;
    holes_[2 * to] = holes_[2 * e];
    holes_[2 * to + 1] = holes_[2 * e + 1];
    jumps_[to] = jumps_[e];
  }
  holes_.resize(map_.halfedges());
  holes_.shrink_to_fit();
  jumps_.resize(map_.halfedges() / 2);
  jumps_.shrink_to_fit();
  Clusters clusters =
      average_clusters(graph_, position_, sources_, cluster, rim_, rank.vertex_count);
  auto meetings = find_meetings(sources_, cluster, graph_.size());
  return {std::move(lattice_), std::move(clusters), std::move(roots), std::move(meetings)};
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
