#include "extract/lattice_triangle.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace meshgrain {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-9;
constexpr double flat = 1, turned = 4;  // flaws

double cross(const LatticePoint& a, const LatticePoint& b) {
  return a[0] * b[1] - a[1] * b[0];
}

LatticePoint point(const std::array<int, 2>& t) {
  return {static_cast<double>(t[0]), static_cast<double>(t[1])};
}

double flaw_of(double area) {
  return area < 0 ? turned * (1 - area) : area < 0.25 ? flat : 0;
}

/// Edges are short: most angles are among a few, by the cross product of two vectors, and by twice
/// their scalar product.
class AngleTable {
 public:
  /// `height`: that of the cell over its side.
  explicit AngleTable(double height) {
    for (int cross = -reach; cross <= reach; ++cross) {
      for (int twice = -reach; twice <= reach; ++twice) {
        angles_[place(cross, twice)] = std::atan2(cross * height, twice / 2.0);
      }
    }
  }
  static bool has(int cross, int twice) {
    return std::abs(cross) <= reach && std::abs(twice) <= reach;
  }
  double at(int cross, int twice) const { return angles_[place(cross, twice)]; }

 private:
  static constexpr int reach = 6, width = 2 * reach + 1;
  static std::size_t place(int cross, int twice) {
    return static_cast<std::size_t>((cross + reach) * width + twice + reach);
  }
  std::array<double, width * width> angles_;
};

LatticePoint operator-(const LatticePoint& a, const LatticePoint& b) {
  return {a[0] - b[0], a[1] - b[1]};
}

/// x with x = t + rotate(x, -rotation).
LatticePoint fixed_point(const Jump& sum, int posy) {
  const auto u = rotate_jump({1, 0}, posy - sum.rotation, posy);
  const auto v = rotate_jump({0, 1}, posy - sum.rotation, posy);
  const int a = 1 - u[0], b = -v[0], c = -u[1], d = 1 - v[1];
  const double determinant = a * d - b * c;
  return {(d * sum.t[0] - b * sum.t[1]) / determinant, (a * sum.t[1] - c * sum.t[0]) / determinant};
}

/// The corners of a cone as they unroll around its apex, which is at zero; the last is the first
/// again.
std::array<LatticePoint, 4> unroll(const LatticeTriangle& cone) {
  const LatticePoint apex = cone.apex();
  const Jump ab = cone.around[0], ac = composed(ab, cone.around[1], cone.posy);
  return {LatticePoint{0, 0} - apex, point(ab.t) - apex, point(ac.t) - apex,
          point(cone.sum().t) - apex};
}

}  // namespace

double LatticeMetric::squared_length(const LatticePoint& a) const {
  return a[0] * a[0] + a[1] * a[1] + (posy == 6 ? a[0] * a[1] : 0);
}

double LatticeMetric::squared_length(const std::array<int, 2>& t) const {
  return squared_length(point(t));
}

double LatticeMetric::angle(const LatticePoint& a, const LatticePoint& b) const {
  const double sine = cross(a, b), cosine = a[0] * b[0] + a[1] * b[1];
  return posy == 4 ? std::atan2(sine, cosine)
                   : std::atan2(sine * std::sqrt(0.75), cosine + (a[0] * b[1] + a[1] * b[0]) / 2);
}

double LatticeMetric::angle(const std::array<int, 2>& a, const std::array<int, 2>& b) const {
  static const AngleTable four(1), six(std::sqrt(0.75));
  const int cross = a[0] * b[1] - a[1] * b[0];
  const int twice = 2 * (a[0] * b[0] + a[1] * b[1]) + (posy == 6 ? a[0] * b[1] + a[1] * b[0] : 0);
  // Opposite vectors may be either way around; it is the signs of zeros that tell.
  const bool is_straight = cross == 0 && twice < 0;
  if (is_straight || !AngleTable::has(cross, twice)) return angle(point(a), point(b));
  return (posy == 6 ? six : four).at(cross, twice);
}

LatticePoint LatticeTriangle::apex(int corner) const {
  return fixed_point(sum(corner), posy);
}

double LatticeTriangle::apex_angle() const {
  const int rotation = sum().rotation;
  return 2 * pi *
         (1 - static_cast<double>(2 * rotation > posy ? rotation - posy : rotation) / posy);
}

double LatticeTriangle::area() const {
  const Jump all = sum();
  if (all.rotation == 0) return flat_area(all.is_zero());
  const auto corners = unroll(*this);
  return cross(corners[0], corners[1]) + cross(corners[1], corners[2]) +
         cross(corners[2], corners[3]);
}

double LatticeTriangle::flat_area(bool is_plane) const {
  const auto seen_from = [&](int corner) {
    const auto& first = around[corner].t;
    const auto second =
        rotate_jump(around[(corner + 1) % 3].t, posy - around[corner].rotation, posy);
    return first[0] * second[1] - first[1] * second[0];
  };
  return is_plane ? seen_from(0) : (seen_from(0) + seen_from(1) + seen_from(2)) / 3.0;
}

double LatticeTriangle::angle(int corner) const {
  const LatticeMetric metric{posy};
  const Jump& to_next = around[corner];
  const std::array<int, 2> last = reversed(around[(corner + 2) % 3], posy).t;
  if (!is_cone()) return metric.angle(to_next.t, last);
  const LatticePoint from = point(to_next.t), to = point(last);
  const LatticePoint top = apex(corner);
  if (metric.squared_length(top) < rounding) {  // the other way around to the last edge
    return metric.angle(from, point(composed(to_next, around[(corner + 1) % 3], posy).t));
  }
  return metric.angle(from, top) + metric.angle(top, to);
}

double LatticeTriangle::flaw() const {
  const Jump all = sum();
  return all.rotation == 0 ? flaw_of(flat_area(all.is_zero())) : flaw_of_cone();
}

double LatticeTriangle::misfit() const {
  const Jump all = sum();
  if (all.rotation != 0) return flaw_of_cone();
  return misfit_of_plane(flat_area(all.is_zero()));
}

double LatticeTriangle::misfit_of_plane(double area) {
  const double flaw = flaw_of(area);
  return flaw == 0 ? std::max(0.0, area - 1) : flaw;
}

double LatticeTriangle::flaw_of_cone() const {
  const LatticeMetric metric{posy};
  const auto corners = unroll(*this);
  double result = 0, size = 0;
  bool apex_is_corner = false;
  for (int k = 0; k < 3; ++k) {
    const double part = cross(corners[k], corners[k + 1]);
    if (part < -rounding) result += turned * (0.5 - part);
    size += part;
    apex_is_corner = apex_is_corner || metric.squared_length(corners[k]) < rounding;
  }
  if (result > 0) return result;
  if (size < 0.25) return flat;
  if (apex_is_corner) return 0;
  double turn = 0;
  for (int k = 0; k < 3; ++k) turn += std::abs(metric.angle(corners[k], corners[k + 1]));
  return std::abs(turn - apex_angle()) < 1e-3 ? 0 : turned;
}

}  // namespace meshgrain
