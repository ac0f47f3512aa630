#pragma once

#include <array>
#include <vector>

#include "meshgrain/fields.h"

namespace meshgrain {

/// What lies between two neighbours' fields (section 3.6): after turning the lattice of j by
/// `rotation` steps, its representative point is that of i moved by `t` along the axes of i.
struct Jump {
  int rotation = 0;
  std::array<int, 2> t{0, 0};

  bool is_zero() const { return t[0] == 0 && t[1] == 0; }
};

/// Whether a jump leads to a neighbouring lattice point, along an edge of the output.
inline bool is_unit(const std::array<int, 2>& t, int posy) {
  const int a = t[0], b = t[1];
  return a * a + b * b + (posy == 6 ? a * b : 0) == 1;
}

/// Turns a lattice vector by `rotation` steps of 360 / posy degrees.
std::array<int, 2> rotate_jump(std::array<int, 2> t, int rotation, int posy);

/// The jump back, in the frame of the other end.
Jump reversed(const Jump& jump, int posy);

/// The jump a -> c by way of b, in the frame of a.
Jump composed(const Jump& ab, const Jump& bc, int posy);

/// The jump from node i to node j, by the matching of the given energy.
Jump edge_jump(const Graph& graph, const OrientationField& orientation,
               const PositionField& position, PositionEnergy energy, Index i, Index j);

/// The jumps of all edges, in the order of Graph::neighbors.
std::vector<Jump> edge_jumps(const Graph& graph, const OrientationField& orientation,
                             const PositionField& position, PositionEnergy energy,
                             const Context& context);

}  // namespace meshgrain
