#include "meshgrain/hierarchy.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <span>

#include "graph/for_each_child.h"
#include "util/collect.h"
#include "util/hash.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 2048;

/// The neighbour of i with the best score of section 3.5 among those that `admits`, or no_index.
/// The score of an edge must be the same seen from both ends, and ties must be broken alike, or
/// proposals could chase each other in circles; a hash of the edge breaks them without a pattern.
template <typename Admits>
Index best_neighbor(const Graph& graph, Index i, const Admits& admits) {
  Index best = no_index;
  float best_score = -1;
  std::uint64_t best_hash = 0;
  for (const Index j : graph.neighbors_of(i)) {
    if (!admits(j)) continue;
    const auto [smaller, larger] = std::minmax(graph.areas[i], graph.areas[j]);
    const float ratio = larger > 0 ? smaller / larger : 1.0f;
    const Index low = std::min(i, j), high = std::max(i, j);
    const float score = std::max(graph.normals[low].dot(graph.normals[high]), 0.0f) * ratio;
    if (score < best_score) continue;
    const std::uint64_t hash = hash64(std::uint64_t{low} << 32 | high);
    if (score > best_score || hash > best_hash) {
      best = j;
      best_score = score;
      best_hash = hash;
    }
  }
  return best;
}

/// For each node the neighbour that it is merged with. Where all neighbours are in pairs already, a
/// node follows one of them and makes it three: left alone, such nodes would pile up around their
/// larger neighbours, which always prefer each other, and the levels would hardly shrink any more.
std::vector<Index> match_pairs(const Graph& graph, const Context& context) {
  const std::size_t n = graph.size();
  std::vector<Index> partner(n, no_index), proposal(n, no_index);
  std::vector<Index> open(n);
  std::iota(open.begin(), open.end(), Index{0});
  const auto is_free = [&](Index j) { return partner[j] == no_index; };
  while (!open.empty()) {
    context.for_ranges(open.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        Index& best = proposal[open[k]];
        if (best != no_index && is_free(best)) continue;  // still the best, as no more are free
        best = best_neighbor(graph, open[k], is_free);
      }
    });
    const auto settle = [&](std::size_t begin, std::size_t end, std::vector<Index>& still_open) {
      for (std::size_t k = begin; k < end; ++k) {
        const Index i = open[k], j = proposal[i];
        if (j == no_index) continue;
        if (proposal[j] == i) {
          partner[i] = j;
        } else {
          still_open.push_back(i);
        }
      }
    };
    open = collect<Index>(open.size(), settle, context);
  }
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (partner[i] != no_index) continue;
      const Index j = best_neighbor(graph, i, [](Index) { return true; });
      partner[i] = j == no_index ? i : j;
    }
  });
  return partner;
}

/// The nodes of the coarser level, each with the finer nodes that it stands for. Numbered in the
/// order of their first children, which keeps the order of the curve.
struct Grouping {
  std::vector<Index> parent;
  std::vector<Index> offsets;  // coarse nodes + 1
  std::vector<Index> children;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const Index> operator[](std::size_t k) const {
    return {children.data() + offsets[k], offsets[k + 1] - offsets[k]};
  }
};

Grouping group(const std::vector<Index>& partner, const Context& context) {
  const std::size_t n = partner.size();
  // A node that found no free neighbour points to one that is in a pair already, in `partner`.
  const auto leader = [&](Index i) {
    const Index j = partner[i];
    return partner[j] == i || partner[j] == j ? std::min(i, j) : std::min(j, partner[j]);
  };
  std::vector<Index> first(n, no_index);  // of the nodes of each leader
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      const std::atomic_ref lowest(first[leader(i)]);
      Index other = lowest.load(std::memory_order_relaxed);
      while (i < other && !lowest.compare_exchange_weak(other, i, std::memory_order_relaxed)) {
      }
    }
  });
  const std::vector<Index> firsts = collect<Index>(
      n,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (auto i = static_cast<Index>(begin); i < end; ++i) {
          if (first[leader(i)] == i) out.push_back(i);
        }
      },
      context);
  Grouping result;
  result.parent.resize(n);
  for (Index k = 0; k < firsts.size(); ++k) result.parent[firsts[k]] = k;
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      const Index other = first[leader(i)];
      if (other != i) result.parent[i] = result.parent[other];
    }
  });
  result.offsets.assign(firsts.size() + 1, 0);
  for_each_child(
      result.parent, [&](Index, Index k) { ++result.offsets[k + 1]; }, context);
  for (std::size_t k = 0; k < result.size(); ++k) result.offsets[k + 1] += result.offsets[k];
  result.children.resize(n);
  std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
  for_each_child(
      result.parent, [&](Index i, Index k) { result.children[next[k]++] = i; }, context);
  return result;
}

void merge_nodes(const Graph& fine, const Grouping& groups, Graph& coarse, const Context& context) {
  const std::size_t n = groups.size();
  coarse.positions.resize(n);
  coarse.normals.resize(n);
  coarse.areas.resize(n);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
      float area = 0, total = 0;
      for (const Index i : groups[k]) {
        const float weight = std::max(fine.areas[i], 1e-30f);
        position += weight * fine.positions[i];
        normal += weight * fine.normals[i];
        area += fine.areas[i];
        total += weight;
      }
      coarse.areas[k] = area;
      coarse.positions[k] = position / total;
      const float length = normal.norm();
      coarse.normals[k] =
          length > 1e-6f * total ? Vec3(normal / length) : fine.normals[groups[k][0]];
    }
  });
}

struct Neighbor {
  Index node;
  float weight;
};

void merge_edges(const Graph& fine, const Grouping& groups, Graph& coarse, const Context& context) {
  const std::size_t n = groups.size();
  coarse.offsets.assign(n + 1, 0);
  // Each range gathers its own neighbours, which then have a known place.
  std::vector<std::vector<Neighbor>> gathered((n + grain - 1) / grain);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    auto& out = gathered[begin / grain];
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t start = out.size();
      for (const Index child : groups[k]) {
        for (Index e = fine.offsets[child]; e < fine.offsets[child + 1]; ++e) {
          const Index node = groups.parent[fine.neighbors[e]];
          if (node != k) out.push_back({node, fine.weight(e)});
        }
      }
      std::sort(out.begin() + static_cast<std::ptrdiff_t>(start), out.end(),
                [](const Neighbor& a, const Neighbor& b) { return a.node < b.node; });
      std::size_t last = start;
      for (std::size_t e = start; e < out.size(); ++e) {
        if (e == start) continue;
        if (out[e].node == out[last].node) {
          out[last].weight += out[e].weight;
        } else {
          out[++last] = out[e];
        }
      }
      if (out.size() > start) out.resize(last + 1);
      coarse.offsets[k + 1] = static_cast<Index>(out.size() - start);
    }
  });
  for (std::size_t k = 0; k < n; ++k) coarse.offsets[k + 1] += coarse.offsets[k];
  coarse.neighbors.resize(coarse.offsets[n]);
  coarse.weights.resize(coarse.offsets[n]);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t) {
    auto& in = gathered[begin / grain];
    std::size_t e = coarse.offsets[begin];
    for (const Neighbor& neighbor : in) {
      coarse.neighbors[e] = neighbor.node;
      coarse.weights[e++] = neighbor.weight;
    }
    in = {};
  });
}

}  // namespace

Hierarchy build_hierarchy(Graph graph, const Context& context) {
  Hierarchy hierarchy;
  const std::size_t finest = graph.size();
  hierarchy.levels.push_back(std::move(graph));
  while (!hierarchy.levels.back().neighbors.empty()) {
    const Graph& fine = hierarchy.levels.back();
    const std::vector<Index> partner = match_pairs(fine, context);
    Grouping groups = group(partner, context);
    Graph coarse;
    merge_nodes(fine, groups, coarse, context);
    merge_edges(fine, groups, coarse, context);
    hierarchy.parents.push_back(std::move(groups.parent));
    hierarchy.levels.push_back(std::move(coarse));
    context.progress("hierarchy", 1.0 - static_cast<double>(hierarchy.levels.back().size()) /
                                            static_cast<double>(finest));
  }
  return hierarchy;
}

}  // namespace meshgrain
