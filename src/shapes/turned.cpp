#include <cmath>
#include <numbers>
#include <vector>

#include "shapes/makers.h"

namespace meshgrain::shapes {
namespace {

/// A corner of a turned profile, in steps of the common edge length.
struct ProfilePoint {
  int radius, height;
};

/// A ring of vertices about the y axis: six for every step of its radius, so that edges are nearly
/// as long as a step everywhere, and a flat ring or disc is nearly a regular triangle mesh.
struct Ring {
  Index first;
  int count;
};

/// Two rings as one band of triangles. They start at the same angle; walk around both at once and
/// always advance on the ring whose next vertex comes first.
void join(Mesh& mesh, Ring low, Ring high) {
  int i = 0, j = 0;
  const auto at = [](Ring ring, int k) { return ring.first + Index(k % ring.count); };
  const int low_end = low.count > 1 ? low.count : 0, high_end = high.count > 1 ? high.count : 0;
  while (i < low_end || j < high_end) {
    const bool on_low =
        j == high_end || (i < low_end && (i + 1) * high.count <= (j + 1) * low.count);
    if (on_low) {
      mesh.faces.push_back({at(low, i), at(high, j), at(low, i + 1)});
      ++i;
    } else {
      mesh.faces.push_back({at(low, i), at(high, j), at(high, j + 1)});
      ++j;
    }
  }
}

/// Turns a profile about the y axis; it runs from a point on the axis up and around to another.
Mesh turn(const std::vector<ProfilePoint>& profile, double step) {
  Mesh mesh;
  const auto add_ring = [&](double radius, double height) {
    const int steps = static_cast<int>(std::lround(radius));
    const Ring ring{static_cast<Index>(mesh.positions.size()), std::max(1, 6 * steps)};
    for (int k = 0; k < ring.count; ++k) {
      const double angle = 2 * std::numbers::pi * k / ring.count;
      mesh.positions.emplace_back(float(step * radius * std::cos(angle)), float(step * height),
                                  float(step * radius * std::sin(angle)));
    }
    return ring;
  };
  Ring last = add_ring(profile[0].radius, profile[0].height);
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const ProfilePoint a = profile[k - 1], b = profile[k];
    // One ring a step, so that every ring has a whole number of steps as its radius where it
    // flares.
    const int across = std::abs(b.radius - a.radius);
    const int rings = across > 0 ? across : std::max(1, std::abs(b.height - a.height));
    for (int r = 1; r <= rings; ++r) {
      const double t = double(r) / rings;
      const Ring next =
          add_ring(a.radius + t * (b.radius - a.radius), a.height + t * (b.height - a.height));
      join(mesh, last, next);
      last = next;
    }
  }
  return mesh;
}

}  // namespace

Mesh cylinder(double resolution) {
  const int r = cells(12, resolution);
  return turn({{0, -r}, {r, -r}, {r, r}, {0, r}}, 0.5 / r);
}

Mesh shaft(double resolution) {
  const int r = cells(4, resolution);
  // Radii in the proportions 2 : 3 : 4 : 2, and a bevelled end.
  return turn({{0, -10 * r},
               {2 * r, -10 * r},
               {2 * r, -5 * r},
               {3 * r, -5 * r},
               {3 * r, -r},
               {4 * r, -r},
               {4 * r, r},
               {2 * r, r},
               {2 * r, 9 * r},
               {r, 10 * r},
               {0, 10 * r}},
              0.1 / r);
}

}  // namespace meshgrain::shapes
