#include "border/match_loop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace meshgrain {
namespace {

/// Slots of a closed loop, that go on over its end.
class Slots {
 public:
  Slots(std::span<const double> places, double period) : places_(places), period_(period) {}

  std::ptrdiff_t count() const { return std::ssize(places_); }

  double place(std::ptrdiff_t slot) const {
    const std::ptrdiff_t round = slot >= 0 ? slot / count() : -((count() - 1 - slot) / count());
    return places_[static_cast<std::size_t>(slot - round * count())] +
           static_cast<double>(round) * period_;
  }

  std::ptrdiff_t nearest(double place_of_point) const {
    const double round = std::floor(place_of_point / period_);
    const double rest = place_of_point - round * period_;
    const auto after = std::ranges::upper_bound(places_, rest) - places_.begin();
    std::ptrdiff_t best = static_cast<std::ptrdiff_t>(round) * count() + after;
    if (std::abs(place(best - 1) - place_of_point) <= std::abs(place(best) - place_of_point)) {
      --best;
    }
    return best;
  }

  /// Squared, in mean distances between slots.
  double distance(const BorderPoint& point, std::ptrdiff_t slot) const {
    const double d = (point.place - place(slot)) * static_cast<double>(count()) / period_;
    return point.weight * d * d;
  }

 private:
  std::span<const double> places_;
  double period_;
};

/// The points from the one on that lies nearest to a slot, or weighs most: that one is sure.
std::size_t surest(std::span<const BorderPoint> points, const Slots& slots) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BorderPoint plain{points[i].place, 1};
    const double cost = slots.distance(plain, slots.nearest(plain.place)) / points[i].weight;
    if (cost < least) {
      least = cost;
      best = i;
    }
  }
  return best;
}

std::vector<BorderPoint> from(std::span<const BorderPoint> points, std::size_t first,
                              double period) {
  std::vector<BorderPoint> result(points.begin() + static_cast<std::ptrdiff_t>(first),
                                  points.end());
  for (std::size_t i = 0; i < first; ++i) {
    result.push_back({points[i].place + period, points[i].weight});
  }
  for (std::size_t i = 1; i < result.size(); ++i) {
    result[i].place = std::clamp(result[i].place, result[i - 1].place, result[0].place + period);
  }
  return result;
}

/// Back to where the points began.
void turn_back(LoopMatch& match, std::size_t first, std::ptrdiff_t slots) {
  const auto begin = match.slots.begin();
  std::rotate(begin, match.slots.end() - static_cast<std::ptrdiff_t>(first), match.slots.end());
  for (std::size_t i = 0; i < first; ++i) match.slots[i] -= slots;
}

}  // namespace

LoopMatch match_loop(std::span<const BorderPoint> all, std::span<const double> places,
                     double period) {
  constexpr double for_merging = 1.5, for_adding = 1.5;
  constexpr std::ptrdiff_t reach = 4;
  constexpr std::size_t width = 2 * reach + 1;
  constexpr double never = std::numeric_limits<double>::infinity();
  const Slots slots(places, period);
  const std::size_t first = surest(all, slots);
  const std::vector<BorderPoint> points = from(all, first, period);
  const std::size_t count = points.size();
  const auto step = [&](std::ptrdiff_t gap) {
    if (gap < 0) return never;
    return gap == 0 ? for_merging : for_adding * static_cast<double>(gap - 1);
  };
  std::vector<std::ptrdiff_t> lowest(count);
  for (std::size_t i = 0; i < count; ++i) lowest[i] = slots.nearest(points[i].place) - reach;
  const std::ptrdiff_t start = lowest[0] + reach, end = start + slots.count();
  std::vector<std::array<double, width>> costs(count);
  std::vector<std::array<std::size_t, width>> before(count);
  costs[0].fill(never);
  costs[0][reach] = slots.distance(points[0], start);
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      const std::ptrdiff_t slot = lowest[i] + static_cast<std::ptrdiff_t>(k);
      costs[i][k] = never;
      for (std::size_t j = 0; j < width; ++j) {
        const std::ptrdiff_t other = lowest[i - 1] + static_cast<std::ptrdiff_t>(j);
        const double cost = costs[i - 1][j] + step(slot - other);
        if (cost >= costs[i][k]) continue;
        costs[i][k] = cost;
        before[i][k] = j;
      }
      costs[i][k] += slots.distance(points[i], slot);
    }
  }
  LoopMatch match{std::vector<std::ptrdiff_t>(count), never};
  std::size_t best = reach;
  for (std::size_t k = 0; k < width; ++k) {
    const double cost =
        costs[count - 1][k] + step(end - lowest[count - 1] - static_cast<std::ptrdiff_t>(k));
    if (cost >= match.cost) continue;
    match.cost = cost;
    best = k;
  }
  for (std::size_t i = count; i-- > 0;) {
    match.slots[i] = lowest[i] + static_cast<std::ptrdiff_t>(best);
    best = before[i][best];
  }
  turn_back(match, first, slots.count());
  return match;
}

LoopMatch match_apart(std::span<const BorderPoint> all, std::span<const double> places,
                      double period) {
  const Slots slots(places, period);
  const std::size_t first = surest(all, slots);
  const std::vector<BorderPoint> points = from(all, first, period);
  const std::ptrdiff_t start = slots.nearest(points[0].place);
  const std::ptrdiff_t spare = slots.count() - std::ssize(points);
  LoopMatch match;
  std::ptrdiff_t skipped = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::ptrdiff_t wanted =
        slots.nearest(points[i].place) - start - static_cast<std::ptrdiff_t>(i);
    skipped = std::clamp(wanted, skipped, spare);
    match.slots.push_back(start + skipped + static_cast<std::ptrdiff_t>(i));
    match.cost += slots.distance(points[i], match.slots.back());
  }
  turn_back(match, first, slots.count());
  return match;
}

}  // namespace meshgrain
