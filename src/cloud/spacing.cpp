#include "cloud/spacing.h"

#include <algorithm>

namespace meshgrain {

std::vector<float> squared_distances(std::span<const Vec3> points, const Neighborhoods& nearest,
                                     const Context& context) {
  constexpr std::size_t grain = 4096;
  std::vector<float> result(points.size(), 0);
  context.for_ranges(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto neighbors = nearest[i];
      float sum = 0;
      for (const Index j : neighbors) sum += (points[j] - points[i]).squaredNorm();
      if (!neighbors.empty()) result[i] = sum / static_cast<float>(neighbors.size());
    }
  });
  return result;
}

float median(std::span<const float> values) {
  if (values.empty()) return 0;
  constexpr std::size_t enough = 1 << 16;
  std::vector<float> some;
  const std::size_t step = 1 + values.size() / enough;
  for (std::size_t i = 0; i < values.size(); i += step) some.push_back(values[i]);
  const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
  std::nth_element(some.begin(), middle, some.end());
  return *middle;
}

}  // namespace meshgrain
