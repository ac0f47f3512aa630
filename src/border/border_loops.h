#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A closed border of a surface, as the halfedges of the hole go around it.
struct BorderLoop {
  std::vector<Index> vertices;  ///< All vertices of the surface on it; the first one is locked.
  std::vector<double> places;   ///< Where each of them is among the locked ones: from 0 on.
  std::vector<Index> locked;    ///< Those that an output with the same border has.
};

struct BorderLoops {
  std::vector<BorderLoop> loops;

  struct Place {
    Index vertex, loop;
    double place;
  };
  std::vector<Place> places;  ///< Of all vertices on borders, sorted by vertex.

  bool empty() const { return loops.empty(); }
  /// More than one where borders touch.
  std::span<const Place> places_of(Index vertex) const;
};

/// The borders of a surface, cut where it is not manifold, that have at least three vertices of
/// those that are `locked` (a flag a vertex).
BorderLoops find_border_loops(const Mesh& surface, std::span<const std::uint8_t> locked,
                              const Context& context);

/// `locked`, and between those that are far from each other along a border others, about `side`
/// apart: an even number of them on each border, if possible, as quads need.
std::vector<std::uint8_t> locked_between(const BorderLoops& borders, const Mesh& surface,
                                         std::span<const std::uint8_t> locked, double side);

}  // namespace meshgrain
