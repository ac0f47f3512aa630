#pragma once

#include <optional>
#include <span>
#include <vector>

namespace meshgrain {

/// A vertex of an extracted border: where it is, and how much it matters that it stays near there.
struct BorderPoint {
  double place, weight;
};

/// Which slot of a border each of its vertices gets.
struct LoopMatch {
  /// In order and never falling; from the number of slots on, again the first ones. Two vertices
  /// with one slot are to become one; slots that are left out need new vertices.
  std::vector<std::ptrdiff_t> slots;
  double cost = 0;
};

/// Gives each of the points of a closed loop one of its slots, so that they move little, and few
/// must be merged or added: by dynamic programming. `slots` are increasing places, `period` is the
/// length of the loop in places.
LoopMatch match_loop(std::span<const BorderPoint> points, std::span<const double> slots,
                     double period);

/// The same without any merging; for no more points than slots.
LoopMatch match_apart(std::span<const BorderPoint> points, std::span<const double> slots,
                      double period);

}  // namespace meshgrain
