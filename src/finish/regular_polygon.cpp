#include "finish/regular_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "finish/face_shape.h"

namespace meshgrain {
namespace {

/// The regular polygon with n corners at a distance of 1 from zero: the directions of the corners,
/// the first along x, and the length of the sides.
struct RegularPolygon {
  std::vector<std::array<float, 2>> corners;
  float side = 0;

  static RegularPolygon of(std::size_t n) {
    const double step = 2 * std::numbers::pi / static_cast<double>(n);
    RegularPolygon result{{}, static_cast<float>(2 * std::sin(step / 2))};
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = step * static_cast<double>(k);
      result.corners.push_back(
          {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
    }
    return result;
  }
};

/// The unit normal of a face with this area vector; none if there is nothing to tell it from.
std::optional<Vec3> upright(const Vec3& area, const Vec3& upward) {
  const float along = area.dot(upward), squared = area.squaredNorm();
  const bool stands = along > 0 && along * along >= 0.04f * squared * upward.squaredNorm();
  const Vec3& normal = stands ? area : upward;
  const float length = normal.norm();
  if (!(length > 0)) return std::nullopt;
  return normal / length;
}

/// The vector from the center to the first corner, drawn towards the length that it should have.
Vec3 resized(Vec3 x, const Vec3& normal, const PolygonFit& fit, float side_of_unit) {
  x -= normal * normal.dot(x);
  const float size = x.norm();
  if (size > 0) x *= 1 - fit.evenness + fit.evenness * fit.side / (side_of_unit * size);
  return x;
}

/// Quads are most of all faces, and their diagonals say everything.
void fit_square(std::span<const Index> face, const std::vector<Vec3>& positions,
                const PolygonFit& fit, std::span<Vec3> corners) {
  const Vec3 &a = positions[face[0]], &b = positions[face[1]], &c = positions[face[2]],
             &d = positions[face[3]];
  const Vec3 center = 0.25f * ((a + c) + (b + d)), along = a - c, across = b - d;
  const auto normal = upright(along.cross(across), fit.upward);
  if (!normal) {
    std::ranges::fill(corners, center);
    return;
  }
  const Vec3 x =
      resized(0.25f * (along - normal->cross(across)), *normal, fit, std::numbers::sqrt2_v<float>);
  const Vec3 y = normal->cross(x);
  corners[0] = center + x;
  corners[1] = center + y;
  corners[2] = center - x;
  corners[3] = center - y;
}

}  // namespace

void fit_regular_polygon(std::span<const Index> face, const std::vector<Vec3>& positions,
                         const PolygonFit& fit, std::span<Vec3> corners) {
  const std::size_t n = face.size();
  if (n == 4) return fit_square(face, positions, fit, corners);
  static const std::array known{RegularPolygon::of(3), RegularPolygon::of(4),
                                RegularPolygon::of(5), RegularPolygon::of(6),
                                RegularPolygon::of(7), RegularPolygon::of(8)};
  const bool is_known = n - 3 < known.size();
  RegularPolygon larger;
  if (!is_known) larger = RegularPolygon::of(n);
  const RegularPolygon& polygon = is_known ? known[n - 3] : larger;
  // The coefficient is the mean of the corners, each turned back by the angle of the polygon's.
  Vec3 center = Vec3::Zero(), along = Vec3::Zero(), across = Vec3::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& p = positions[face[k]];
    center += p;
    along += polygon.corners[k][0] * p;
    across += polygon.corners[k][1] * p;
  }
  const auto count = static_cast<float>(n);
  center /= count;
  const auto normal = upright(area_vector(face, positions), fit.upward);
  if (!normal) {
    std::ranges::fill(corners, center);
    return;
  }
  const Vec3 x = resized((along - normal->cross(across)) / count, *normal, fit, polygon.side);
  const Vec3 y = normal->cross(x);
  for (std::size_t k = 0; k < n; ++k) {
    corners[k] = center + polygon.corners[k][0] * x + polygon.corners[k][1] * y;
  }
}

}  // namespace meshgrain
