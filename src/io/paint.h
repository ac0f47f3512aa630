#pragma once

#include <algorithm>

namespace meshgrain::io {

/// What is kept of a colour whose parts go from 0 to 1 (ReadOptions::paint).
inline float paint_of(double red, double green, double blue) {
  return static_cast<float>(std::clamp(red - (green + blue) / 2, -1.0, 1.0));
}

}  // namespace meshgrain::io
