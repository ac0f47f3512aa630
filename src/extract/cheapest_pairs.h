#pragma once

#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// What it costs that one goes with another. Several may go with `nobody`.
struct Match {
  static constexpr Index nobody = no_index - 1;
  double cost;
  Index with;
};

/// Pairs those that `matches` is of, each with one that it could go with, or with nobody: first
/// whoever costs least, then two pairs change partners as long as that costs less. Returns with
/// whom each goes; no_index where all that it could go with are taken.
std::vector<Index> cheapest_pairs(std::span<const std::vector<Match>> matches);

}  // namespace meshgrain
