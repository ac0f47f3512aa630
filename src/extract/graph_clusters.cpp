#include "extract/graph_clusters.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <tuple>
#include <utility>

#include "extract/contested_cluster.h"
#include "extract/entry_jumps.h"
#include "util/edge_of.h"
#include "util/indices.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

/// For each entry of Graph::neighbors, the lower node first, what its jump makes of it.
std::vector<Link> classify_edges(const Graph& graph, const OrientationField& orientation,
                                 const PositionField& position, PositionEnergy energy,
                                 const Context& context) {
  std::vector<Link> links(graph.neighbors.size(), Link::other);
  for_entry_jumps(
      graph, orientation, position, energy, [](Index, Index) { return true; },
      [&](Index entry, const Jump& jump) {
        if (jump.is_zero()) {
          links[entry] = Link::zero;
        } else if (is_unit(jump.t, position.posy)) {
          links[entry] = Link::unit;
        }
      },
      context);
  return links;
}

class GraphCollapse {
 public:
  GraphCollapse(const Graph& graph, const PositionField& position, std::vector<Link> links,
                const Context& context)
      : graph_(graph), position_(position), links_(std::move(links)), context_(context) {}

  CollapsedGraph run(const std::vector<std::array<Index, 2>>& border_edges) {
    unite_zero_jumps();
    part_contested();
    number_clusters();
    std::vector<std::uint8_t> on_border(graph_.size(), 0);
    for (const auto& [i, j] : border_edges) on_border[i] = on_border[j] = 1;
    CollapsedGraph result;
    result.clusters = average(on_border);
    drop_spurious(result.clusters);
    result.edges = unit_edges();
    for (const auto& [i, j] : border_edges) append_edge(i, j, result.border);
    sort_unique(result.border);
    return result;
  }

 private:
  template <typename Body>
  void for_nodes(const Body& body) const {
    for_indices(graph_.size(), body, context_);
  }

  /// Calls `body(j)` for the neighbours j > i to which such a link leads.
  template <typename Body>
  void for_links(Index i, Link link, const Body& body) const {
    for (Index e = graph_.offsets[i]; e < graph_.offsets[i + 1]; ++e) {
      if (links_[e] == link) body(graph_.neighbors[e]);
    }
  }

  void unite_zero_jumps() {
    SharedUnionFind sets(graph_.size());
    for_nodes([&](Index i) { for_links(i, Link::zero, [&](Index j) { sets.unite(i, j); }); });
    cluster_.resize(graph_.size());
    for_nodes([&](Index i) { cluster_[i] = sets.find(i); });
  }

  /// Two nodes that an edge of G' joins must stay apart. Where zero jumps join them all the same,
  /// the integers contradict each other, and the cluster is made anew with care. Clusters do not
  /// depend on each other, as zero jumps join none of them.
  void part_contested() {
    std::vector<std::uint8_t> is_contested(graph_.size(), 0);
    for_nodes([&](Index i) {
      for_links(i, Link::unit, [&](Index j) {
        if (cluster_[i] != cluster_[j]) return;
        std::atomic_ref(is_contested[cluster_[i]]).store(1, std::memory_order_relaxed);
      });
    });
    std::vector<Index> nodes = indices_where(
        graph_.size(), [&](Index i) { return is_contested[cluster_[i]] != 0; }, context_);
    std::ranges::stable_sort(nodes, {}, [&](Index i) { return cluster_[i]; });
    std::vector<std::span<const Index>> members;  // of each contested cluster
    for (auto i = nodes.cbegin(); i != nodes.cend();) {
      const auto end =
          std::find_if(i, nodes.cend(), [&](Index j) { return cluster_[j] != cluster_[*i]; });
      members.emplace_back(i, end);
      i = end;
    }
    std::vector<std::vector<Index>> parts(members.size());
    context_.for_ranges(members.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        parts[c] = part_contested_cluster(graph_, links_, position_.points, members[c]);
      }
    });
    for (std::size_t c = 0; c < members.size(); ++c) {
      for (std::size_t m = 0; m < members[c].size(); ++m) cluster_[members[c][m]] = parts[c][m];
    }
  }

  /// In the order of their first members, which keeps the order of the curve.
  void number_clusters() {
    const std::vector<Index> first = indices_where(
        graph_.size(), [&](Index i) { return cluster_[i] == i; }, context_);
    std::vector<Index> number(graph_.size());
    for_indices(
        first.size(), [&](Index c) { number[first[c]] = c; }, context_);
    for_nodes([&](Index i) { cluster_[i] = number[cluster_[i]]; });
    count_ = first.size();
  }

  Clusters average(const std::vector<std::uint8_t>& on_border) const {
    std::vector<Index> nodes(graph_.size());
    std::iota(nodes.begin(), nodes.end(), Index{0});
    return average_clusters(graph_, position_, nodes, cluster_, on_border, on_border, count_,
                            context_);
  }

  /// Spurious clusters cover nearly nothing of an output cell; the paper counts nodes instead,
  /// which is the same where the input is even.
  void drop_spurious(Clusters& clusters) {
    const auto is_kept = [&](Index c) { return clusters.cover[c] >= 0.1f; };
    const std::vector<Index> kept = indices_where(count_, is_kept, context_);
    std::vector<Index> number(count_, no_index);
    for (Index k = 0; k < kept.size(); ++k) number[kept[k]] = k;
    for_nodes([&](Index i) { cluster_[i] = number[cluster_[i]]; });
    clusters.keep(kept);
    count_ = kept.size();
  }

  /// The edge between the clusters of two nodes, if there is one.
  void append_edge(Index i, Index j, std::vector<std::array<Index, 2>>& out) const {
    const auto edge = edge_of(cluster_[i], cluster_[j]);
    if (edge[1] != no_index && edge[0] != edge[1]) out.push_back(edge);
  }

  std::vector<std::array<Index, 2>> unit_edges() const {
    using Edge = std::array<Index, 2>;
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Edge>& out) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) {
        for_links(i, Link::unit, [&](Index j) { append_edge(i, j, out); });
      }
      sort_unique(out);
    };
    std::vector<Edge> edges = collect<Edge>(graph_.size(), find, context_);
    sort_unique(edges, context_);
    return edges;
  }

  const Graph& graph_;
  const PositionField& position_;
  std::vector<Link> links_;
  const Context& context_;
  std::vector<Index> cluster_;  // of each node: its first member; its number, once it has one
  std::size_t count_ = 0;       // of clusters
};

}  // namespace

CollapsedGraph collapse_graph(const Graph& graph, const OrientationField& orientation,
                              const PositionField& position, const ExtractOptions& options,
                              const Context& context) {
  std::vector<Link> links = classify_edges(graph, orientation, position, options.energy, context);
  context.progress("extraction", 0.5);
  return GraphCollapse(graph, position, std::move(links), context).run(options.border);
}

}  // namespace meshgrain
