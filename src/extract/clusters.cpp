#include "extract/clusters.h"

#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "field/jumps.h"
#include "mesh/sort_by_vertex.h"
#include "util/edge_of.h"
#include "util/indices.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// An edge whose ends share a lattice point.
struct Merge {
  float distance;
  Index i, j;
  bool operator<(const Merge& other) const {
    return std::tie(distance, i, j) < std::tie(other.distance, other.i, other.j);
  }
};

/// Disjoint sets that can list their members.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n), next_(n), size_(n, 1) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
    std::iota(next_.begin(), next_.end(), Index{0});
  }

  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  Index size(Index root) const { return size_[root]; }

  void unite(Index a, Index b) {
    if (size_[a] < size_[b]) std::swap(a, b);
    parent_[b] = a;
    size_[a] += size_[b];
    std::swap(next_[a], next_[b]);  // joins the two rings of members
  }

  template <typename Body>
  bool any_member(Index root, const Body& body) {
    Index i = root;
    do {
      if (body(i)) return true;
      i = next_[i];
    } while (i != root);
    return false;
  }

 private:
  std::vector<Index> parent_, next_, size_;
};

/// The edges of G': those of the graph whose jump is a unit vector, as a list for each node.
struct UnitEdges {
  std::vector<Index> offsets;
  std::vector<Index> ends;
};

void classify_edges(const Graph& graph, const OrientationField& orientation,
                    const PositionField& position, PositionEnergy energy,
                    std::vector<Merge>& merges, UnitEdges& units, const Context& context) {
  constexpr std::size_t grain = 4096;
  const std::size_t n = graph.size();
  struct Found {
    std::vector<Merge> merges;
    std::vector<std::array<Index, 2>> units;
  };
  std::vector<Found> found((n + grain - 1) / grain);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    Found& out = found[begin / grain];
    std::vector<std::array<Index, 2>> edges;
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      for (const Index j : graph.neighbors_of(i)) {
        if (j > i) edges.push_back({i, j});
      }
    }
    const std::vector<Jump> jumps = edge_jumps(graph, orientation, position, energy, edges);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto [i, j] = edges[e];
      if (jumps[e].is_zero()) {
        out.merges.push_back({(position.points[i] - position.points[j]).norm(), i, j});
      } else if (is_unit(jumps[e].t, position.posy)) {
        out.units.push_back({i, j});
      }
    }
  });
  units.offsets.assign(n + 1, 0);
  for (const Found& range : found) {
    for (const auto& [i, j] : range.units) {
      ++units.offsets[i + 1];
      ++units.offsets[j + 1];
    }
  }
  for (std::size_t i = 0; i < n; ++i) units.offsets[i + 1] += units.offsets[i];
  units.ends.resize(units.offsets[n]);
  std::vector<Index> next(units.offsets.begin(), units.offsets.end() - 1);
  for (Found& range : found) {
    for (const auto& [i, j] : range.units) {
      units.ends[next[i]++] = j;
      units.ends[next[j]++] = i;
    }
    merges.insert(merges.end(), range.merges.begin(), range.merges.end());
    range = {};
  }
  context.run([&] { tbb::parallel_sort(merges); });
}

/// Shortest first; two clusters that an edge of G' joins stay apart, as the integers there
/// contradict each other.
void merge_clusters(const std::vector<Merge>& merges, const UnitEdges& units, DisjointSets& sets,
                    const Context& context) {
  std::size_t done = 0;
  for (const Merge& merge : merges) {
    if ((done++ & 0xffff) == 0) {
      context.progress("extraction",
                       0.2 + 0.6 * static_cast<double>(done) / static_cast<double>(merges.size()));
    }
    Index a = sets.find(merge.i), b = sets.find(merge.j);
    if (a == b) continue;
    if (sets.size(a) < sets.size(b)) std::swap(a, b);
    const bool conflict = sets.any_member(b, [&](Index member) {
      for (Index e = units.offsets[member]; e < units.offsets[member + 1]; ++e) {
        if (sets.find(units.ends[e]) == a) return true;
      }
      return false;
    });
    if (!conflict) sets.unite(a, b);
  }
}

}  // namespace

Clusters average_clusters(const Graph& graph, const PositionField& position,
                          std::span<const Index> nodes, std::span<const Index> cluster_of,
                          std::span<const std::uint8_t> border, std::span<const std::uint8_t> hold,
                          std::size_t count, const Context& context) {
  // The members of each cluster, in order.
  UninitializedVector<Index> members(nodes.size());
  const std::vector<Index> offsets = sort_by_vertex(
      nodes.size(), count,
      [&](std::size_t m) {
        return std::span<const Index>(&cluster_of[m], cluster_of[m] == no_index ? 0 : 1);
      },
      [&](std::size_t m, Index place) { members[place] = nodes[m]; }, context);
  Clusters result;
  result.positions.resize(count);
  result.normals.resize(count);
  result.on_border.resize(count);
  result.cover.resize(count);
  result.nodes.resize(count);
  const auto average = [&](Index c) {
    const std::span<const Index> here(members.data() + offsets[c], offsets[c + 1] - offsets[c]);
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    float weight = 0, cover = 0;
    std::uint8_t on_border = 0, most_held = 0;
    for (const Index i : here) {
      const float rho = position.edge_length[i], beta = rho / 3;
      // Never quite zero: a cluster whose members are all far from its lattice point needs a place
      // too.
      const float alpha = std::max(
          std::exp(-(position.points[i] - graph.positions[i]).squaredNorm() / (beta * beta)),
          1e-20f);
      point += alpha * position.points[i];
      normal += alpha * graph.normals[i];
      weight += alpha;
      cover += graph.areas[i] / (rho * rho);
      on_border |= border[i];
      most_held = std::max(most_held, hold[i]);
    }
    point /= weight;
    const float length = normal.norm();
    result.positions[c] = point;
    result.normals[c] = length > 0 ? Vec3(normal / length) : Vec3(Vec3::UnitZ());
    result.on_border[c] = on_border;
    result.cover[c] = cover;
    float nearest = 0;
    Index& node = result.nodes[c] = no_index;
    for (const Index i : here) {
      if (hold[i] < most_held) continue;
      const float distance = (graph.positions[i] - point).squaredNorm();
      if (node != no_index && distance >= nearest) continue;
      nearest = distance;
      node = i;
    }
  };
  for_indices(count, average, context);
  const float mean_cover =
      std::accumulate(result.cover.begin(), result.cover.end(), 0.0f) / static_cast<float>(count);
  for (float& cover : result.cover) cover /= mean_cover;
  return result;
}

void Clusters::append_mean(std::span<const Index> some) {
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  for (const Index c : some) {
    position += positions[c];
    normal += normals[c];
  }
  const Index first = some[0];
  positions.push_back(position / static_cast<float>(some.size()));
  const float length = normal.norm();
  normals.push_back(length > 1e-6f ? Vec3(normal / length) : normals[first]);
  nodes.push_back(nodes[first]);
  on_border.push_back(0);
  hold.push_back(free_vertex);
}

Clusters collapse_clusters(const Graph& graph, const OrientationField& orientation,
                           const PositionField& position, const ExtractOptions& options,
                           const Context& context) {
  const std::size_t n = graph.size();
  std::vector<Merge> merges;
  UnitEdges units;
  context.progress("extraction", 0);
  classify_edges(graph, orientation, position, options.energy, merges, units, context);
  DisjointSets sets(n);
  merge_clusters(merges, units, sets, context);
  merges = {};

  // Clusters in the order of their first members, which keeps the order of the curve.
  std::vector<Index> cluster_of(n), id(n, no_index);
  Index count = 0;
  for (Index i = 0; i < n; ++i) {
    Index& c = id[sets.find(i)];
    if (c == no_index) c = count++;
    cluster_of[i] = c;
  }

  // The share of a whole output cell that a cluster covers. Spurious ones cover nearly nothing; the
  // paper counts nodes instead, which is the same where the input is even.
  std::vector<double> cover(count, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double rho = position.edge_length[i];
    cover[cluster_of[i]] += graph.areas[i] / (rho * rho);
  }
  const double mean = std::accumulate(cover.begin(), cover.end(), 0.0) / std::max<Index>(count, 1);

  std::vector<Index> kept(count, no_index);
  Index kept_count = 0;
  for (Index c = 0; c < count; ++c) {
    if (cover[c] >= mean / 10) kept[c] = kept_count++;
  }
  for (Index& c : cluster_of) c = kept[c];
  std::vector<std::uint8_t> border(n, 0);
  for (const auto& [i, j] : options.border) border[i] = border[j] = 1;
  std::vector<Index> nodes(n);
  std::iota(nodes.begin(), nodes.end(), Index{0});
  Clusters result =
      average_clusters(graph, position, nodes, cluster_of, border, border, kept_count, context);

  const auto clusters_of_edge = [&](Index i, Index j) {
    return edge_of(cluster_of[i], cluster_of[j]);
  };
  for (Index i = 0; i < n; ++i) {
    for (Index e = units.offsets[i]; e < units.offsets[i + 1]; ++e) {
      if (units.ends[e] < i) continue;
      const auto edge = clusters_of_edge(i, units.ends[e]);
      if (edge[1] != no_index && edge[0] != edge[1]) result.edges.push_back(edge);
    }
  }
  sort_unique(result.edges);
  for (const auto& [i, j] : options.border) {
    const auto edge = clusters_of_edge(i, j);
    if (edge[1] != no_index && edge[0] != edge[1]) result.border.push_back(edge);
  }
  sort_unique(result.border);
  return result;
}

}  // namespace meshgrain
