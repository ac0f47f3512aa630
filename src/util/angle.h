#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace meshgrain {

/// std::atan2(sine, cosine) of a sine that is not negative, both times any positive factor, but for
/// a few roundings: without branches or calls, so that loops of it become SIMD.
inline double quick_angle(double sine, double cosine) {
  const double adjacent = std::abs(cosine);
  const double larger = std::max(sine, adjacent), smaller = std::min(sine, adjacent);
  // A quarter of the angle to the nearest axis, which is at most 1/8 of a turn, has so small a
  // tangent that the series of the arc tangent soon ends.
  const double whole = std::max(larger, std::numeric_limits<double>::min());
  const double half = smaller / (whole + std::sqrt(whole * whole + smaller * smaller));
  const double t = half / (1 + std::sqrt(1 + half * half)), t2 = t * t;
  double sum = 0;
  for (int n = 21; n > 0; n -= 2) sum = (n % 4 == 1 ? 1.0 : -1.0) / n + t2 * sum;
  const double nearest = 4 * t * sum;
  const double acute = sine > adjacent ? std::numbers::pi / 2 - nearest : nearest;
  return cosine < 0 ? std::numbers::pi - acute : acute;
}

}  // namespace meshgrain
