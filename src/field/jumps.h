#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshgrain/fields.h"

namespace meshgrain {

/// What lies between two neighbours' fields (section 3.6): after turning the lattice of j by
/// `rotation` steps, its representative point is that of i moved by `t` along the axes of i.
struct Jump {
  int rotation = 0;
  std::array<int, 2> t{0, 0};

  bool is_zero() const { return t[0] == 0 && t[1] == 0; }
  bool operator==(const Jump&) const = default;
};

/// Whether a jump leads to a neighbouring lattice point, along an edge of the output.
inline bool is_unit(const std::array<int, 2>& t, int posy) {
  const int a = t[0], b = t[1];
  return a * a + b * b + (posy == 6 ? a * b : 0) == 1;
}

/// Turns a lattice vector by `rotation` steps of 360 / posy degrees; 0 <= rotation <= posy.
inline std::array<int, 2> rotate_jump(const std::array<int, 2>& t, int rotation, int posy) {
  const int half = posy / 2;
  const bool is_opposite = rotation >= half && rotation < posy;
  const int x = is_opposite ? -t[0] : t[0], y = is_opposite ? -t[1] : t[1];
  const int steps = rotation == posy ? 0 : rotation - (is_opposite ? half : 0);
  if (steps == 0) return {x, y};
  if (posy == 4) return {-y, x};
  return steps == 1 ? std::array<int, 2>{-y, x + y} : std::array<int, 2>{-x - y, x};
}

/// The jump back, in the frame of the other end.
inline Jump reversed(const Jump& jump, int posy) {
  const auto t = rotate_jump(jump.t, jump.rotation, posy);
  return {jump.rotation == 0 ? 0 : posy - jump.rotation, {-t[0], -t[1]}};
}

/// The jump a -> c by way of b, in the frame of a.
inline Jump composed(const Jump& ab, const Jump& bc, int posy) {
  const auto t = rotate_jump(bc.t, posy - ab.rotation, posy);
  const int rotation = ab.rotation + bc.rotation;
  return {rotation < posy ? rotation : rotation - posy, {ab.t[0] + t[0], ab.t[1] + t[1]}};
}

/// The jumps of directed edges, from their first nodes to their second ones, by the matching of the
/// given energy.
std::vector<Jump> edge_jumps(const Graph& graph, const OrientationField& orientation,
                             const PositionField& position, PositionEnergy energy,
                             std::span<const std::array<Index, 2>> edges);

/// That of a single one. Many at once are several times as fast.
Jump edge_jump(const Graph& graph, const OrientationField& orientation,
               const PositionField& position, PositionEnergy energy, Index i, Index j);

}  // namespace meshgrain
