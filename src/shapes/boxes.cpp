#include <Eigen/Core>
#include <array>
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

Mesh fused_boxes(double resolution) {
  // A box lies on the plane y = 0, another one stands on it, tilted towards +x: it meets the top of
  // the first in a rectangle, and goes on so far along `up` as its own top, across that, says.
  constexpr double length = 1, height = 0.6, width = 0.6, side = 0.3, reach = 1;
  const double tilt = std::numbers::pi / 6;
  const Eigen::Vector3d up(std::sin(tilt), std::cos(tilt), 0), middle(0, height, 0);
  const double foot = side / std::cos(tilt);
  const auto raised = [&](double x, double z, double share) {
    const Eigen::Vector3d p(x, height, z);
    return Vec3((p + share * (reach - (p - middle).dot(up)) * up).cast<float>());
  };
  // All patches end where the tilted box does, so that their borders have the same vertices.
  const auto count = [&](double run) { return cells(2 * std::round(8 * run), resolution); };
  struct Part {
    double from, to;
    int cells;
    double at(double t) const { return from + t * (to - from); }
  };
  const std::array<Part, 3> along{{{-length, -foot, count(length - foot)},
                                   {-foot, foot, count(2 * foot)},
                                   {foot, length, count(length - foot)}}};
  const std::array<Part, 3> across{{{-width, -side, count(width - side)},
                                    {-side, side, count(2 * side)},
                                    {side, width, count(width - side)}}};
  const int rows = count(height), raised_rows = count(reach);
  const auto point = [](double x, double y, double z) {
    return Vec3(Eigen::Vector3d(x, y, z).cast<float>());
  };
  PatchBuilder patches;
  for (const Part& x : along) {
    for (const Part& z : across) {
      patches.grid(x.cells, z.cells,
                   [&](double u, double v) { return point(x.at(u), 0, z.at(v)); });
      const bool under_foot = &x == &along[1] && &z == &across[1];
      patches.grid(z.cells, x.cells, [&](double u, double v) {
        return raised(x.at(v), z.at(u), under_foot ? 1 : 0);
      });
    }
    patches.grid(x.cells, rows,
                 [&](double u, double v) { return point(x.at(u), height * v, width); });
    patches.grid(rows, x.cells,
                 [&](double u, double v) { return point(x.at(v), height * u, -width); });
  }
  for (const Part& z : across) {
    patches.grid(rows, z.cells,
                 [&](double u, double v) { return point(length, height * u, z.at(v)); });
    patches.grid(z.cells, rows,
                 [&](double u, double v) { return point(-length, height * v, z.at(u)); });
  }
  const Part &x = along[1], &z = across[1];
  patches.grid(raised_rows, z.cells, [&](double u, double v) { return raised(foot, z.at(v), u); });
  patches.grid(z.cells, raised_rows, [&](double u, double v) { return raised(-foot, z.at(u), v); });
  patches.grid(x.cells, raised_rows, [&](double u, double v) { return raised(x.at(u), side, v); });
  patches.grid(raised_rows, x.cells, [&](double u, double v) { return raised(x.at(v), -side, u); });
  return patches.take();
}

}  // namespace meshgrain::shapes
