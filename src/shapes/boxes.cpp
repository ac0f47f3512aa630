#include <cmath>
#include <numbers>

#include "shapes/makers.h"
#include "shapes/patches.h"

namespace meshgrain::shapes {
namespace {

/// The unit cube about the origin, each of its points moved by `bend`.
template <class Bend>
Mesh box(int cells, Bend&& bend) {
  PatchBuilder patches;
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-0.5f, 0.5f})
      patches.grid(cells, cells, [&](double u, double v) {
        if (side < 0) std::swap(u, v);  // turns the patch to face the other way
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = float(u - 0.5);
        p[(axis + 2) % 3] = float(v - 0.5);
        return bend(p);
      });
  return patches.take();
}

}  // namespace

Mesh plate(double resolution) {
  const int n = cells(24, resolution);
  PatchBuilder patches;
  patches.grid(n, n, [](double u, double v) { return Vec3(float(u - 0.5), float(v - 0.5), 0.0f); });
  return patches.take();
}

Mesh cube(double resolution) {
  return box(cells(24, resolution), [](const Vec3& p) { return p; });
}

Mesh twisted_cube(double resolution) {
  return box(cells(32, resolution), [](const Vec3& p) {
    const float angle = std::numbers::pi_v<float> / 2 * p.y();
    const float c = std::cos(angle), s = std::sin(angle);
    return Vec3(c * p.x() + s * p.z(), p.y(), -s * p.x() + c * p.z());
  });
}

}  // namespace meshgrain::shapes
