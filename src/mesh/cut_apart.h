#pragma once

#include <array>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Where a surface was cut.
struct Cuts {
  /// Of each vertex, the one that it was: the copies come after all others. Empty: there are none.
  std::vector<Index> sources;
  /// The edges that were cut, as each side has them now, sorted, the smaller index first.
  std::vector<std::array<Index, 2>> edges;

  bool empty() const { return edges.empty(); }
};

/// Cuts a triangle mesh along its edges that are neither on the border nor between two faces of
/// opposite direction. Pairs of faces there stay together (pair_around_edge()), others get a
/// border. Vertices of these edges become one a fan of faces, at the same place; what else is not
/// manifold stays as it is.
Cuts cut_apart(Mesh& triangles, const Context& context);

/// Undoes that.
void join_again(Mesh& triangles, const Cuts& cuts);

}  // namespace meshgrain
