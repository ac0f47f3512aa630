#pragma once

#include <algorithm>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// A way, or as much of it as is `longest` long.
inline Vec3 shortened(const Vec3& way, float longest) {
  return way * std::min(1.0f, longest / std::max(way.norm(), 1e-30f));
}

}  // namespace meshgrain
