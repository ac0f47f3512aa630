#include "extract/cheapest_pairs.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace meshgrain {
namespace {

constexpr Index nobody = Match::nobody;

class Pairing {
 public:
  explicit Pairing(std::span<const std::vector<Match>> matches)
      : matches_(matches), partner_(matches.size(), no_index) {}

  void begin_with_cheapest() {
    std::vector<std::tuple<double, Index, Index>> pairs;
    for (Index i = 0; i < matches_.size(); ++i) {
      for (const Match& match : matches_[i]) pairs.emplace_back(match.cost, i, match.with);
    }
    std::ranges::sort(pairs);
    for (const auto& [cost, i, j] : pairs) {
      if (partner_[i] == no_index && (j == nobody || partner_[j] == no_index)) join(i, j);
    }
  }

  /// Returns whether any two pairs changed partners. The cost falls each time, so that it ends.
  bool change_partners() {
    constexpr double least_gain = 1e-6;
    bool any = false;
    for (Index i = 0; i < matches_.size(); ++i) {
      for (const auto& [own_cost, k] : matches_[i]) {
        const Index j = partner_[i];
        if (j == no_index || j == k) continue;
        const Index l = k == nobody ? nobody : partner_[k];
        if (l == no_index) continue;
        if (cost(i, k) + cost(j, l) + least_gain > cost(i, j) + cost(k, l)) continue;
        join(i, k);
        join(j, l);
        any = true;
      }
    }
    return any;
  }

  std::vector<Index> partners() && { return std::move(partner_); }

 private:
  void join(Index i, Index j) {
    if (i != nobody) partner_[i] = j;
    if (j != nobody) partner_[j] = i;
  }

  /// The same from both sides, or pairs could change partners forever.
  double cost(Index i, Index j) const {
    constexpr double impossible = 1e6;
    if (i == nobody && j == nobody) return 0;
    double least = impossible;
    for (const auto& [one, other] : {std::pair(i, j), std::pair(j, i)}) {
      if (one == nobody) continue;
      const auto it = std::ranges::find(matches_[one], other, &Match::with);
      if (it != matches_[one].end()) least = std::min(least, it->cost);
    }
    return least;
  }

  std::span<const std::vector<Match>> matches_;
  std::vector<Index> partner_;
};

}  // namespace

std::vector<Index> cheapest_pairs(std::span<const std::vector<Match>> matches) {
  Pairing pairing(matches);
  pairing.begin_with_cheapest();
  while (pairing.change_partners()) {
  }
  return std::move(pairing).partners();
}

}  // namespace meshgrain
