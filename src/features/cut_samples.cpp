#include "features/cut_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>

#include "util/edge_of.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// The lines as they were before the cut.
class CutLines {
 public:
  CutLines(const Cuts& cuts, const FeatureLines& features) {
    std::vector<std::array<Index, 2>> edges;
    for (const auto& [a, b] : cuts.edges)
      edges.push_back(edge_of(cuts.sources[a], cuts.sources[b]));
    sort_unique(edges);
    for (const auto& [a, b] : edges) {
      neighbors_[a].push_back(b);
      neighbors_[b].push_back(a);
    }
    for (const Index v : features.corners) corners_.push_back(cuts.sources[v]);
    sort_unique(corners_);
  }

  /// Each from one end to the next; closed ones that have none begin and end with the same vertex.
  std::vector<std::vector<Index>> chains() {
    std::vector<std::vector<Index>> result;
    for (const auto& [v, around] : neighbors_) {
      if (!is_end(v)) continue;
      for (const Index w : around) {
        if (!is_used(v, w)) result.push_back(follow(v, w));
      }
    }
    for (const auto& [v, around] : neighbors_) {
      if (!is_end(v) && !is_used(v, around[0])) result.push_back(follow(v, around[0]));
    }
    return result;
  }

 private:
  bool is_end(Index v) const {
    return neighbors_.at(v).size() != 2 || std::ranges::binary_search(corners_, v);
  }
  bool is_used(Index v, Index w) const { return used_.contains(edge_of(v, w)); }

  std::vector<Index> follow(Index start, Index next) {
    std::vector<Index> chain{start};
    for (Index last = start;;) {
      used_.insert(edge_of(last, next));
      chain.push_back(next);
      if (next == start || is_end(next)) return chain;
      const auto& around = neighbors_.at(next);
      const Index ahead = around[0] == last ? around[1] : around[0];
      last = next;
      next = ahead;
    }
  }

  std::map<Index, std::vector<Index>> neighbors_;
  std::set<std::array<Index, 2>> used_;
  std::vector<Index> corners_;
};

/// The nearest of evenly spaced points along a chain, for each of its vertices.
std::vector<Vec3> nearest_samples(const std::vector<Index>& chain, const Mesh& surface,
                                  const EdgeLength& lengths) {
  std::vector<double> at(chain.size(), 0);  // in edges of the lattice
  for (std::size_t k = 1; k < chain.size(); ++k) {
    const Index a = chain[k - 1], b = chain[k];
    const double length = (surface.positions[b] - surface.positions[a]).norm();
    at[k] = at[k - 1] + 2 * length / (double{lengths[a]} + double{lengths[b]});
  }
  std::vector<Vec3> result;
  if (!(at.back() > 0)) {
    for (const Index v : chain) result.push_back(surface.positions[v]);
    return result;
  }
  const double least = chain.front() == chain.back() ? 3 : 1;
  const double count = std::max(least, std::round(at.back()));
  std::size_t k = 1;
  for (const double place : at) {
    const double sample = std::round(place / at.back() * count) / count * at.back();
    while (k + 1 < chain.size() && at[k] < sample) ++k;
    while (k > 1 && at[k - 1] > sample) --k;
    const double share = at[k] > at[k - 1] ? (sample - at[k - 1]) / (at[k] - at[k - 1]) : 0;
    const Vec3 &p = surface.positions[chain[k - 1]], &q = surface.positions[chain[k]];
    result.emplace_back(p + static_cast<float>(std::clamp(share, 0.0, 1.0)) * (q - p));
  }
  return result;
}

}  // namespace

std::vector<PositionConstraint> sample_cuts(const Cuts& cuts, const Mesh& surface,
                                            const FeatureLines& features,
                                            const EdgeLength& lengths) {
  if (cuts.empty()) return {};
  std::map<Index, Vec3> samples;  // of vertices as they were
  for (const std::vector<Index>& chain : CutLines(cuts, features).chains()) {
    const std::vector<Vec3> nearest = nearest_samples(chain, surface, lengths);
    for (std::size_t k = 0; k < chain.size(); ++k) samples.try_emplace(chain[k], nearest[k]);
  }
  std::vector<Index> vertices;
  for (const auto& [a, b] : cuts.edges) vertices.insert(vertices.end(), {a, b});
  sort_unique(vertices);
  std::vector<PositionConstraint> result;
  for (const Index v : vertices) {
    result.push_back({v, samples.at(cuts.sources[v]), Vec3::Zero(), 1});
  }
  return result;
}

}  // namespace meshgrain
