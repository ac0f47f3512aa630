#include <array>
#include <cmath>
#include <numbers>

#include "shapes/makers.h"
#include "shapes/patches.h"

namespace meshgrain::shapes {
namespace {

/// A geodesic sphere: the icosahedron's faces in `cells` x `cells` triangles, pushed out to the
/// unit sphere and on to `radius(direction)` times that.
template <class Radius>
Mesh geodesic(int cells, Radius&& radius) {
  const float g = std::numbers::phi_v<float>;
  const std::array<Vec3, 12> corners{{{-1, g, 0},
                                      {1, g, 0},
                                      {-1, -g, 0},
                                      {1, -g, 0},
                                      {0, -1, g},
                                      {0, 1, g},
                                      {0, -1, -g},
                                      {0, 1, -g},
                                      {g, 0, -1},
                                      {g, 0, 1},
                                      {-g, 0, -1},
                                      {-g, 0, 1}}};
  constexpr int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  PatchBuilder patches;
  for (const auto& face : faces)
    patches.triangle(cells, [&](double a, double b, double c) {
      const Vec3 p =
          float(a) * corners[face[0]] + float(b) * corners[face[1]] + float(c) * corners[face[2]];
      const Vec3 direction = p.normalized();
      return Vec3(radius(direction) * direction);
    });
  return patches.take();
}

}  // namespace

Mesh sphere(double resolution) {
  return geodesic(cells(16, resolution), [](const Vec3&) { return 1.0f; });
}

Mesh blob(double resolution) {
  struct Bump {
    Vec3 towards;
    float height, sharpness;
  };
  const std::array<Bump, 8> bumps{{{{0.2f, 1.0f, 0.1f}, 0.55f, 6.0f},
                                   {{-0.9f, 0.5f, 0.4f}, 0.40f, 9.0f},
                                   {{0.9f, 0.3f, 0.6f}, 0.45f, 8.0f},
                                   {{0.1f, -0.4f, 1.0f}, -0.30f, 7.0f},
                                   {{-0.5f, -0.9f, 0.3f}, 0.50f, 7.0f},
                                   {{0.7f, -0.8f, -0.1f}, 0.35f, 9.0f},
                                   {{0.3f, 0.2f, -1.0f}, 0.45f, 6.0f},
                                   {{-0.8f, -0.1f, -0.7f}, -0.25f, 8.0f}}};
  return geodesic(cells(24, resolution), [&](const Vec3& direction) {
    float radius = 0.85f;
    for (const Bump& bump : bumps) {
      const float cosine = direction.dot(bump.towards.normalized());
      radius += bump.height * std::exp(bump.sharpness * (cosine - 1));
    }
    return radius;
  });
}

Mesh torus(double resolution) {
  constexpr double large = 1.0, small = 0.4, full = 2 * std::numbers::pi;
  PatchBuilder patches;
  patches.grid(cells(80, resolution, 3), cells(32, resolution, 3), [&](double u, double v) {
    const double around = large + small * std::cos(full * v);
    return Vec3(float(around * std::cos(full * u)), float(around * std::sin(full * u)),
                float(small * std::sin(full * v)));
  });
  return patches.take();
}

}  // namespace meshgrain::shapes
