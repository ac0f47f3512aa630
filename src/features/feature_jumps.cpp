#include "features/feature_jumps.h"

#include <cmath>

#include "field/posy.h"
#include "field/with_symmetry.h"

namespace meshgrain {
namespace {

/// A jump of i without its part across the axis that runs most nearly along `d`.
template <int S>
std::array<int, 2> along_axis(const std::array<int, 2>& t, const Vec3& direction,
                              const Vec3& normal, const Vec3& d) {
  int best = 0;
  float largest = -1;
  for (int k = 0; k < S; ++k) {
    const float along = RoSy<S>::rotate(direction, normal, k).dot(d);
    if (along <= largest) continue;
    largest = along;
    best = k;
  }
  const auto u = rotate_jump({1, 0}, best, S);
  // The scalar product in units of the lattice.
  const double product =
      t[0] * u[0] + t[1] * u[1] + (S == 6 ? 0.5 * (t[0] * u[1] + t[1] * u[0]) : 0);
  const int length = static_cast<int>(std::lround(product));
  return {length * u[0], length * u[1]};
}

}  // namespace

Jump FeatureJumps::into_corner(Index i, Index corner) const {
  Jump jump = edge_jump(graph_, orientation_, position_, energy_, i, corner);
  const Vec3 &ni = graph_.normals[i], &oi = orientation_.directions[i];
  const Vec3& xi = graph_.positions[i];
  // As far as it is over the surface.
  Vec3 d = graph_.positions[corner] - xi;
  const Vec3 flat = d - ni * ni.dot(d);
  if (flat.norm() > 0) d = flat * (d.norm() / flat.norm());
  jump.t = with_posy(position_.posy, [&]<int S>() {
    return PoSy<S>(position_.points[i], oi, ni, position_.edge_length[i]).round(xi + d);
  });
  return jump;
}

std::vector<Jump> FeatureJumps::jumps(std::span<const std::array<Index, 2>> edges) const {
  std::vector<Jump> result = edge_jumps(graph_, orientation_, position_, energy_, edges);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [i, j] = edges[e];
    if (starts_at_corner({i, j})) result[e] = reversed(into_corner(j, i), position_.posy);
    if (starts_at_corner({j, i})) result[e] = into_corner(i, j);
  }
  return result;
}

Jump FeatureJumps::aligned(const std::array<Index, 2>& edge, const Jump& jump) const {
  const auto [i, j] = edge;
  if (starts_at_corner(edge)) {
    return reversed(aligned({j, i}, reversed(jump, position_.posy)), position_.posy);
  }
  const auto t = with_posy(position_.posy, [&]<int S>() {
    return along_axis<S>(jump.t, orientation_.directions[i], graph_.normals[i],
                         graph_.positions[j] - graph_.positions[i]);
  });
  return {jump.rotation, t};
}

bool is_along_axis(const std::array<int, 2>& t, int posy) {
  return t[0] == 0 || t[1] == 0 || (posy == 6 && t[0] == -t[1]);
}

}  // namespace meshgrain
