#include "extract/free_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace meshgrain {
namespace {

/// A lattice point from the origin of an edge, and its squared distance to some goal.
struct Nearest {
  std::array<int, 2> t{0, 0};
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// Of the lattice points inside of the triangle between h and the point `top` (which is seen from
/// h's origin too), the one nearest to `goal`; on the sides towards the top counts as inside.
Nearest nearest_inside(const LatticeMesh& lattice, Index h, const LatticePoint& top,
                       const LatticePoint& goal) {
  const auto b = lattice.jump(h).t;
  const auto low = [&](int k) {
    return static_cast<int>(std::floor(std::min({0.0, top[k], static_cast<double>(b[k])})));
  };
  const auto high = [&](int k) {
    return static_cast<int>(std::ceil(std::max({0.0, top[k], static_cast<double>(b[k])})));
  };
  Nearest nearest;
  for (int x = low(0); x <= high(0); ++x) {
    for (int y = low(1); y <= high(1); ++y) {
      if ((x == 0 && y == 0) || (x == b[0] && y == b[1])) continue;
      const double over_edge = b[0] * y - b[1] * x;
      const double over_right = (top[0] - b[0]) * (y - b[1]) - (top[1] - b[1]) * (x - b[0]);
      const double over_left = -top[0] * y + top[1] * x;
      if (over_edge <= 0 || over_right < 0 || over_left < 0) continue;
      const double distance =
          lattice.metric().squared_length(LatticePoint{x - goal[0], y - goal[1]});
      if (distance < nearest.squared_distance) nearest = {{x, y}, distance};
    }
  }
  return nearest;
}

std::optional<FreePoint> find_in_plane(const LatticeMesh& lattice, Index h) {
  const auto b = lattice.jump(h).t;
  const Jump ac = composed(lattice.jump(h), lattice.jump(lattice.map.next(h)), lattice.posy);
  const LatticePoint c{static_cast<double>(ac.t[0]), static_cast<double>(ac.t[1])};
  const Nearest point = nearest_inside(lattice, h, c, {(b[0] + c[0]) / 3, (b[1] + c[1]) / 3});
  if (!std::isfinite(point.squared_distance) || point.t == ac.t) return std::nullopt;
  return FreePoint{h, point.t,
                   composed(reversed(Jump{0, point.t}, lattice.posy), ac, lattice.posy)};
}

std::optional<FreePoint> find_in_cone(const LatticeMesh& lattice, LatticePieces& pieces, Index h) {
  Nearest nearest;
  Index edge = no_index;
  Index g = h;
  for (int side = 0; side < 3; ++side, g = lattice.map.next(g)) {
    const LatticePoint apex = lattice.triangle(g).apex();
    const Nearest found = nearest_inside(lattice, g, apex, apex);
    if (found.squared_distance >= nearest.squared_distance) continue;
    nearest = found;
    edge = g;
  }
  if (edge == no_index) return std::nullopt;
  // Of the three new triangles that on the edge is plane, and one of the others: the jump to the
  // corner beyond may go by either end of the edge.
  const int posy = lattice.posy;
  const LatticePiece whole = pieces.piece(edge);
  const auto [a, b, c] = whole.corners;
  const auto& [ab, bc, ca] = whole.lattice.around;
  const Jump ax{0, nearest.t}, xa = reversed(ax, posy), xb = composed(xa, ab, posy);
  constexpr double most = 3;  // of what the parts may cost
  double least = most;
  const Jump* best = nullptr;
  const Jump ways[2] = {composed(xb, bc, posy), composed(xa, reversed(ca, posy), posy)};
  for (const Jump& xc : ways) {
    if (xc.is_zero()) return std::nullopt;  // the apex is that corner
    const std::array<LatticePiece, 3> parts{
        {{{a, b, no_index}, {posy, {ab, reversed(xb, posy), xa}}},
         {{b, c, no_index}, {posy, {bc, reversed(xc, posy), xb}}},
         {{c, a, no_index}, {posy, {ca, ax, xc}}}}};
    const double cost = flaws(parts) + 0.01 * lattice.metric().squared_length(xc.t);
    if (cost >= least || !pieces.keep_angles({&whole, 1}, parts)) continue;
    least = cost;
    best = &xc;
  }
  if (best == nullptr) return std::nullopt;
  return FreePoint{edge, nearest.t, *best};
}

}  // namespace

bool may_have_free_point(const LatticeTriangle& triangle) {
  if (triangle.is_cone()) return triangle.flaw() == 0;
  constexpr double least = 3, rounding = 0.5;  // twice the area with one point inside (Pick)
  return triangle.is_plane() && triangle.area() > least - rounding;
}

std::optional<FreePoint> find_free_point(const LatticeMesh& lattice, LatticePieces& pieces,
                                         Index h) {
  return lattice.triangle(h).is_cone() ? find_in_cone(lattice, pieces, h)
                                       : find_in_plane(lattice, h);
}

}  // namespace meshgrain
