#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace meshgrain {

/// The angle, from 0 to pi, with this sine, which is not negative, and cosine, both times any
/// positive factor (0 if both are 0): about as exact as single precision (Abramowitz and Stegun
/// 1964, 4.4.49), and without branches or calls, so that loops of it become SIMD.
inline float quick_angle(float sine, float cosine) {
  const float adjacent = std::abs(cosine), larger = std::max(sine, adjacent);
  const float t = std::min(sine, adjacent) / std::max(larger, std::numeric_limits<float>::min());
  const float t2 = t * t;
  constexpr float series[] = {0.0028662257f,  -0.0161657367f, 0.0429096138f,
                              -0.0752896400f, 0.1065626393f,  -0.1420889944f,
                              0.1999355085f,  -0.3333314528f, 1.0f};
  float sum = 0;
  for (const float term : series) sum = sum * t2 + term;
  constexpr float pi = std::numbers::pi_v<float>;
  const float acute = sine > adjacent ? pi / 2 - t * sum : t * sum;
  return cosine < 0 ? pi - acute : acute;
}

}  // namespace meshgrain
