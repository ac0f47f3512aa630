#pragma once

#include <array>
#include <optional>

#include "extract/lattice_mesh.h"
#include "extract/lattice_pieces.h"

namespace meshgrain {

/// Whether there may be a lattice point inside of a triangle, which has no vertex then.
bool may_have_free_point(const LatticeTriangle& triangle);

/// What LatticeMesh::insert() needs to put a vertex at a lattice point inside of the triangle left
/// of an edge: the point, from the edge's origin, and the jump from it to the corner beyond.
struct FreePoint {
  Index edge;
  std::array<int, 2> t;
  Jump to_apex;
};

/// A lattice point inside of the triangle left of h (or on the sides beyond h): in a plane triangle
/// the one nearest to the middle, in a cone the one nearest to the apex. None where the parts that
/// a vertex there would make of the triangle are too flawed.
std::optional<FreePoint> find_free_point(const LatticeMesh& lattice, LatticePieces& pieces,
                                         Index h);

}  // namespace meshgrain
