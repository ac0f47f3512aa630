#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "shapes/makers.h"
#include "shapes/patches.h"

namespace meshgrain::shapes {
namespace {

using Vec2 = Eigen::Vector2d;

// The bracket stands on the plane y = 0: a foot along x, an upright along y that ends in a round
// eye about the hole, both as wide as the eye (along z) and of one thickness; a fillet between
// them.
constexpr double foot = 2.6, thickness = 0.5, fillet = 0.6, half_width = 1.0, bore = 0.55;
constexpr double bend = thickness + fillet;                    // where the straight parts begin
constexpr double eye_base = 1.4, eye = eye_base + half_width;  // the eye's square part; its centre

/// A run of the side view: the outer and the inner outline at the same parameter in [0, 1].
struct Run {
  int cells;
  std::function<Vec2(double)> outer, inner;
};

Vec2 mix(const Vec2& a, const Vec2& b, double t) {
  return (1 - t) * a + t * b;
}

/// The outline of the eye as (y, z) offsets from its centre, clockwise seen along -x: half a circle
/// above, and half a square below, where the straight sides go on. `t` in [0, 1] runs half way
/// around above, and in [1, 5] along the four edges of half a width below.
Vec2 eye_outline(double t) {
  const double s = half_width;
  if (t <= 1) {
    const double angle = std::numbers::pi * t;
    return {s * std::sin(angle), s * std::cos(angle)};
  }
  if (t <= 2) return {-s * (t - 1), -s};
  if (t <= 4) return {-s, s * (t - 3)};
  return {-s * (5 - t), s};
}

/// The point of the bore that a structured mesh joins to eye_outline(t).
Vec2 bore_outline(double t) {
  const double angle = std::numbers::pi * (t <= 1 ? t : 1 + (t - 1) / 4);
  return {bore * std::sin(angle), bore * std::cos(angle)};
}

}  // namespace

Mesh bracket(double resolution) {
  const double step = 0.1;
  const auto along = [&](double length) { return cells(length / step, resolution); };
  const Vec3 centre(float(foot / 2), float((eye + half_width) / 2), 0);
  const auto place = [&](double x, double y, double z) {
    return Vec3(Vec3(float(x), float(y), float(z)) - centre);
  };
  const int across = along(2 * half_width), deep = along(1.2 * thickness);
  const int corner = along(0.65 * bend);  // fewer: the fillet is shorter than the corner around it

  // The side view from the foot's end to the eye's centre, with the bend in two runs that part at
  // the outer corner, so that the corner is a vertex.
  const auto arc = [](double t) {  // the fillet, t in [0, 1]
    const double angle = std::numbers::pi / 2 * t;
    return Vec2(bend - fillet * std::sin(angle), bend - fillet * std::cos(angle));
  };
  const auto line = [](Vec2 a, Vec2 b) { return [=](double t) { return mix(a, b, t); }; };
  const std::vector<Run> runs{
      {along(foot - bend), line({foot, 0}, {bend, 0}), line({foot, thickness}, {bend, thickness})},
      {corner, line({bend, 0}, {0, 0}), [&](double t) { return arc(t / 2); }},
      {corner, line({0, 0}, {0, bend}), [&](double t) { return arc(0.5 + t / 2); }},
      {along(eye_base - bend), line({0, bend}, {0, eye_base}),
       line({thickness, bend}, {thickness, eye_base})},
      {along(half_width), line({0, eye_base}, {0, eye}),
       line({thickness, eye_base}, {thickness, eye})},
  };

  PatchBuilder patches;
  for (const Run& run : runs) {
    // Both sides, and (where the eye does not take their place) the outer and the inner surface.
    for (double side : {-half_width, half_width})
      patches.grid(run.cells, deep, [&](double u, double v) {
        if (side < 0) u = 1 - u;
        const Vec2 p = mix(run.inner(u), run.outer(u), v);
        return place(p.x(), p.y(), side);
      });
    if (&run == &runs.back()) break;
    patches.grid(run.cells, across, [&](double u, double v) {
      const Vec2 p = run.outer(u);
      return place(p.x(), p.y(), half_width * (1 - 2 * v));
    });
    patches.grid(run.cells, across, [&](double u, double v) {
      const Vec2 p = run.inner(u);
      return place(p.x(), p.y(), half_width * (2 * v - 1));
    });
  }
  // The end of the foot.
  patches.grid(deep, across, [&](double u, double v) {
    return place(foot, thickness * u, half_width * (2 * v - 1));
  });

  // The eye: both faces and the bore in the pieces of its outline, and its rounded rim.
  const int half_circle = along(std::numbers::pi * half_width), quarter = along(half_width);
  // Layers that grow with the distance from the hole's axis, as the edges around it do.
  const double growth = half_width / bore;
  const int layers = along(half_width * std::log(growth));
  struct Piece {
    double from, to;
    int cells;
  };
  const Piece pieces[] = {{0, 1, half_circle}, {1, 2, quarter}, {2, 4, across}, {4, 5, quarter}};
  for (const Piece& piece : pieces) {
    const auto t = [&](double u) { return piece.from + (piece.to - piece.from) * u; };
    const auto ring = [&](double x, double u, double v) {
      const double outwards = (std::pow(growth, v) - 1) / (growth - 1);
      const Vec2 p = mix(bore_outline(t(u)), eye_outline(t(u)), outwards);
      return place(x, eye + p.x(), p.y());
    };
    patches.grid(piece.cells, layers, [&](double u, double v) { return ring(0, 1 - u, v); });
    patches.grid(piece.cells, layers, [&](double u, double v) { return ring(thickness, u, v); });
    patches.grid(piece.cells, deep, [&](double u, double v) { return ring(thickness * v, u, 0); });
  }
  patches.grid(half_circle, deep, [&](double u, double v) {
    const Vec2 p = eye_outline(u);
    return place(thickness * (1 - v), eye + p.x(), p.y());
  });
  return patches.take();
}

}  // namespace meshgrain::shapes
