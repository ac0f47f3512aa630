#include "graph/match_pairs.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>
#include <numeric>

#include "util/hash.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "graph/match_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "graph/lanes.h"
#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// The scores of all edges of the nodes [begin, end), and the neighbour of the best one; `ties`
/// gets the nodes that have several of these.
void score_edges(const Graph& graph, Index begin, Index end, float* scores, Index* best,
                 std::vector<Index>& ties) {
  for_range(begin, end, [&](const Ints& nodes, Index first, Index count) {
    const Vec3s n = gather(graph.normals.data(), nodes);
    const Floats area = gather(graph.areas.data(), nodes);
    NeighborLanes around(graph, nodes);
    Ints best_neighbor = hn::Set(IntLanes(), -1);
    Floats best_score = all(-1);
    Mask is_tie = hn::Gt(best_score, all(0));
    HWY_ALIGN std::int32_t entries[most_lanes], active[most_lanes];
    HWY_ALIGN float values[most_lanes];
    while (around.next()) {
      // Must be the same seen from both ends, or proposals could chase each other in circles.
      const Floats other = gather(graph.areas.data(), around.neighbors);
      const Floats larger = hn::Max(area, other);
      const Floats ratio = choose(hn::Gt(larger, all(0)), hn::Min(area, other) / larger, all(1));
      const Floats cosine = dot(n, gather(graph.normals.data(), around.neighbors));
      const Floats score = hn::Max(cosine, all(0)) * ratio;
      const Mask better = hn::And(around.active, hn::Gt(score, best_score));
      is_tie =
          hn::Or(hn::AndNot(better, is_tie), hn::And(around.active, hn::Eq(score, best_score)));
      best_score = choose(better, score, best_score);
      best_neighbor =
          hn::IfThenElse(hn::RebindMask(IntLanes(), better), around.neighbors, best_neighbor);
      hn::Store(around.entries, IntLanes(), entries);
      hn::Store(score, Lanes(), values);
      hn::Store(hn::VecFromMask(IntLanes(), hn::RebindMask(IntLanes(), around.active)), IntLanes(),
                active);
      for (Index k = 0; k < count; ++k) {
        if (active[k] != 0) scores[entries[k]] = values[k];
      }
    }
    HWY_ALIGN std::int32_t neighbors[most_lanes];
    hn::Store(best_neighbor, IntLanes(), neighbors);
    for (Index k = 0; k < count; ++k) best[first + k] = static_cast<Index>(neighbors[k]);
    if (hn::AllFalse(Lanes(), is_tie)) return;
    hn::Store(hn::VecFromMask(Lanes(), is_tie), Lanes(), values);
    for (Index k = 0; k < count; ++k) {
      if (std::bit_cast<std::int32_t>(values[k]) != 0) ties.push_back(first + k);
    }
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {
namespace {

/// Proposals by rounds, first within ranges of nodes, then for those that wait for a node of
/// another range within larger ones. Each pair is better than all that its nodes could still have,
/// so that it does not matter who comes first, nor that a range may learn late what another one
/// has taken: the pairs are always the same.
class PairMatching {
 public:
  explicit PairMatching(const Graph& graph)
      : graph_(graph),
        partner_(graph.size(), no_index),
        proposal_(std::make_unique_for_overwrite<Index[]>(graph.size())),
        scores_(std::make_unique_for_overwrite<float[]>(graph.neighbors.size())) {}

  std::vector<Index> run(const Context& context) && {
    const std::size_t n = graph_.size();
    std::size_t size = 2048;
    std::vector<std::vector<Index>> open((n + size - 1) / size);
    context.for_ranges(n, size, [&](std::size_t begin, std::size_t end) {
      std::vector<Index>& nodes = open[begin / size];
      nodes.resize(end - begin);
      std::iota(nodes.begin(), nodes.end(), static_cast<Index>(begin));
      std::vector<Index> ties;
      MESHGRAIN_BEST_TARGET(score_edges)
      (graph_, static_cast<Index>(begin), static_cast<Index>(end), scores_.get(), proposal_.get(),
       ties);
      for (const Index i : ties) proposal_[i] = best_neighbor(i);
      while (pair_up(nodes, begin, end)) propose_anew(nodes);
    });
    while (open.size() > 1) {
      constexpr std::size_t growth = 8;
      size *= growth;
      std::vector<std::vector<Index>> larger((n + size - 1) / size);
      context.for_ranges(n, size, [&](std::size_t begin, std::size_t end) {
        const std::size_t r = begin / size;
        for (std::size_t k = r * growth; k < std::min((r + 1) * growth, open.size()); ++k) {
          larger[r].insert(larger[r].end(), open[k].begin(), open[k].end());
        }
        do {
          propose_anew(larger[r]);
        } while (pair_up(larger[r], begin, end));
      });
      open.swap(larger);
    }
    return std::move(partner_);
  }

 private:
  static std::uint64_t hash_of_edge(Index i, Index j) {
    return hash64(std::uint64_t{std::min(i, j)} << 32 | std::max(i, j));
  }

  bool is_free(Index i) {
    return std::atomic_ref(partner_[i]).load(std::memory_order_relaxed) == no_index;
  }
  void match(Index i, Index with) {
    std::atomic_ref(partner_[i]).store(with, std::memory_order_relaxed);
  }

  /// The best of some neighbours. Without branches that would be foretold badly; ties are rare.
  struct Best {
    Index entry = no_index;
    std::int32_t key = -1;  // of the score, which is not negative: its bits
    bool is_tie = false;

    void take(Index e, std::int32_t k) {
      is_tie |= k == key;
      entry = k > key ? e : entry;
      key = std::max(k, key);
    }
  };

  /// Among equals, that of the largest hash: a choice by indices would make patterns.
  template <typename Admits>
  Index neighbor(Index i, const Best& best, const Admits& admits) const {
    if (best.entry == no_index) return no_index;
    Index result = graph_.neighbors[best.entry];
    if (!best.is_tie) return result;
    for (Index e = best.entry + 1; e < graph_.offsets[i + 1]; ++e) {
      const Index j = graph_.neighbors[e];
      if (key(e) == best.key && admits(j) && hash_of_edge(i, j) > hash_of_edge(i, result)) {
        result = j;
      }
    }
    return result;
  }

  std::int32_t key(Index entry) const { return std::bit_cast<std::int32_t>(scores_[entry]); }

  Index best_free_neighbor(Index i) {
    Best best;
    for (Index e = graph_.offsets[i]; e < graph_.offsets[i + 1]; ++e) {
      best.take(e, is_free(graph_.neighbors[e]) ? key(e) : -2);
    }
    return neighbor(i, best, [&](Index j) { return is_free(j); });
  }

  Index best_neighbor(Index i) const {
    Best best;
    for (Index e = graph_.offsets[i]; e < graph_.offsets[i + 1]; ++e) best.take(e, key(e));
    return neighbor(i, best, [](Index) { return true; });
  }

  void propose_anew(const std::vector<Index>& open) {
    for (const Index i : open) {
      const Index j = proposal_[i];
      // One that is free is still the best, as no more become free.
      if (j == no_index || !is_free(j)) proposal_[i] = best_free_neighbor(i);
    }
  }

  /// Takes the nodes that agree, and those that find all neighbours taken, out of `open`, the free
  /// nodes of [begin, end). Those that wait, one for the other, for a node beyond stay. Returns
  /// false when no others are left.
  bool pair_up(std::vector<Index>& open, std::size_t begin, std::size_t end) {
    return std::erase_if(open, [&](Index i) {
             const Index j = proposal_[i];
             if (j == no_index) {
               const Index followed = best_neighbor(i);
               match(i, followed == no_index ? i : followed);
               return true;
             }
             if (j < begin || j >= end || proposal_[j] != i) return false;
             match(i, j);
             return true;
           }) > 0;
  }

  const Graph& graph_;
  std::vector<Index> partner_;
  std::unique_ptr<Index[]> proposal_;
  std::unique_ptr<float[]> scores_;
};

}  // namespace

std::vector<Index> match_pairs(const Graph& graph, const Context& context) {
  return PairMatching(graph).run(context);
}

}  // namespace meshgrain
#endif
