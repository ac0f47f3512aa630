#include "border/border_slots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace meshgrain {
namespace {

Slots all_slots(const BorderLoop& loop) {
  Slots slots(loop.locked.size());
  for (std::size_t k = 0; k < slots.size(); ++k) slots[k] = static_cast<double>(k);
  return slots;
}

/// Every second one from `start`, but at least three. What an odd number leaves over is between the
/// first two.
Slots second_slots(const BorderLoop& loop, std::size_t start) {
  const std::size_t count = loop.locked.size();
  std::vector<std::size_t> gaps(std::max<std::size_t>(3, (count + 1) / 2), 2);
  for (std::size_t k = 0; k < 2 * gaps.size() - count; ++k) gaps[k] = 1;
  Slots slots;
  std::size_t place = start;
  for (const std::size_t gap : gaps) {
    slots.push_back(static_cast<double>(place % count));
    place += gap;
  }
  std::ranges::sort(slots);
  return slots;
}

/// The locked vertices at the corners of a border, or the first one if it has none.
std::vector<std::size_t> corners_of(std::span<const BorderPoint> points, std::size_t count) {
  const auto round = static_cast<std::ptrdiff_t>(count);
  std::vector<std::size_t> corners;
  for (const BorderPoint& point : points) {
    if (point.weight <= 1) continue;
    const auto place = static_cast<std::ptrdiff_t>(std::lround(point.place));
    corners.push_back(static_cast<std::size_t>(((place % round) + round) % round));
  }
  std::ranges::sort(corners);
  constexpr std::size_t most = 16;
  if (corners.size() > most) corners.resize(most);
  if (corners.empty()) corners.push_back(0);
  return corners;
}

/// Where to begin with every second vertex: of an odd number, at a long edge of each part between
/// two corners.
std::vector<std::size_t> starts(const BorderLoop& loop, std::span<const BorderPoint> points,
                                const Graph& graph) {
  const std::size_t count = loop.locked.size();
  if (count == 4) return {0, 1, 2, 3};
  if (count % 2 == 0) return {0, 1};
  const std::vector<std::size_t> corners = corners_of(points, count);
  std::vector<std::size_t> result;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t end = c + 1 < corners.size() ? corners[c + 1] : corners[0] + count;
    std::size_t best = corners[c];
    float longest = 0;
    for (std::size_t k = corners[c]; k < end; ++k) {
      const Vec3& p = graph.positions[loop.locked[k % count]];
      const float length = (graph.positions[loop.locked[(k + 1) % count]] - p).norm();
      if (length <= 1.0001f * longest) continue;
      longest = length;
      best = k % count;
    }
    result.push_back(best);
  }
  return result;
}

}  // namespace

std::vector<Slots> slot_choices(const BorderLoop& loop, std::span<const BorderPoint> points,
                                const Graph& graph, OutputFaces faces) {
  if (faces != OutputFaces::quads) return {all_slots(loop)};
  std::vector<Slots> result;
  for (const std::size_t start : starts(loop, points, graph)) {
    result.push_back(second_slots(loop, start));
  }
  return result;
}

}  // namespace meshgrain
