#include "meshgrain/hierarchy.h"

#include <algorithm>
#include <cmath>

#include "util/hash.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 2048;

/// For each node the neighbour that it is merged with, or itself.
std::vector<Index> match_pairs(const Graph& graph, const Context& context) {
  const std::size_t n = graph.size();
  std::vector<Index> partner(n, no_index);
  std::vector<Index> proposal(n, no_index);

  // The score of an edge must be the same seen from both ends, and ties must be broken alike, or
  // proposals could chase each other in circles; a hash of the edge breaks them without a pattern.
  const auto propose = [&](Index i) {
    Index best = no_index;
    float best_score = -1;
    std::uint64_t best_hash = 0;
    for (const Index j : graph.neighbors_of(i)) {
      if (partner[j] != no_index || j == i) continue;
      const float a = graph.areas[i], b = graph.areas[j];
      const float ratio = a < b ? a / b : b > 0 ? b / a : 1.0f;
      // Products in the order of the indices: the same bits from both ends.
      const Vec3& low = graph.normals[std::min(i, j)];
      const Vec3& high = graph.normals[std::max(i, j)];
      const float score = std::max(low.dot(high), 0.0f) * ratio;
      if (score < best_score) continue;
      const std::uint64_t h = hash64(std::uint64_t{std::min(i, j)} << 32 | std::max(i, j));
      if (score > best_score || h > best_hash) {
        best = j;
        best_score = score;
        best_hash = h;
      }
    }
    return best;
  };

  std::vector<Index> open(n);
  for (std::size_t i = 0; i < n; ++i) open[i] = static_cast<Index>(i);
  while (!open.empty()) {
    context.for_ranges(open.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) proposal[open[k]] = propose(open[k]);
    });
    std::size_t kept = 0;
    for (const Index i : open) {
      const Index j = proposal[i];
      if (j == no_index) {
        partner[i] = i;  // no free neighbour left: moves up alone
      } else if (proposal[j] == i) {
        partner[i] = j;
      } else {
        open[kept++] = i;
      }
    }
    open.resize(kept);
  }
  return partner;
}

/// Parents are numbered in the order of their first child, which keeps the order of the curve.
std::vector<Index> number_parents(const std::vector<Index>& partner, std::vector<Index>& first_child) {
  std::vector<Index> parent(partner.size());
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] < i) {
      parent[i] = parent[partner[i]];
    } else {
      parent[i] = static_cast<Index>(first_child.size());
      first_child.push_back(static_cast<Index>(i));
    }
  }
  return parent;
}

void merge_nodes(const Graph& fine, const std::vector<Index>& partner,
                 const std::vector<Index>& first_child, Graph& coarse, const Context& context) {
  const std::size_t n = first_child.size();
  coarse.positions.resize(n);
  coarse.normals.resize(n);
  coarse.areas.resize(n);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Index a = first_child[k], b = partner[a];
      if (a == b) {
        coarse.positions[k] = fine.positions[a];
        coarse.normals[k] = fine.normals[a];
        coarse.areas[k] = fine.areas[a];
        continue;
      }
      const float area = fine.areas[a] + fine.areas[b];
      const float share = area > 0 ? fine.areas[a] / area : 0.5f;
      coarse.areas[k] = area;
      coarse.positions[k] = share * fine.positions[a] + (1 - share) * fine.positions[b];
      const Vec3 normal = share * fine.normals[a] + (1 - share) * fine.normals[b];
      const float length = normal.norm();
      coarse.normals[k] = length > 1e-6f ? Vec3(normal / length) : fine.normals[a];
    }
  });
}

struct Neighbor {
  Index node;
  float weight;
};

void merge_edges(const Graph& fine, const std::vector<Index>& partner,
                 const std::vector<Index>& parent, const std::vector<Index>& first_child,
                 Graph& coarse, const Context& context) {
  const std::size_t n = first_child.size();
  coarse.offsets.assign(n + 1, 0);
  // Each range gathers its own neighbours, which then have a known place.
  std::vector<std::vector<Neighbor>> gathered((n + grain - 1) / grain);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    auto& out = gathered[begin / grain];
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t start = out.size();
      const auto gather = [&](Index child) {
        for (Index e = fine.offsets[child]; e < fine.offsets[child + 1]; ++e) {
          const Index node = parent[fine.neighbors[e]];
          if (node != k) out.push_back({node, fine.weight(e)});
        }
      };
      gather(first_child[k]);
      if (partner[first_child[k]] != first_child[k]) gather(partner[first_child[k]]);
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
    std::vector<Index> first_child;
    std::vector<Index> parent = number_parents(partner, first_child);
    Graph coarse;
    merge_nodes(fine, partner, first_child, coarse, context);
    merge_edges(fine, partner, parent, first_child, coarse, context);
    hierarchy.parents.push_back(std::move(parent));
    hierarchy.levels.push_back(std::move(coarse));
    context.progress("hierarchy", 1.0 - static_cast<double>(hierarchy.levels.back().size()) /
                                            static_cast<double>(finest));
  }
  return hierarchy;
}

}  // namespace meshgrain
