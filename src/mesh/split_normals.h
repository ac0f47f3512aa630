#pragma once

#include <array>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The normals that a file gives to the corners of faces, to shade them.
struct CornerNormals {
  std::vector<Vec3> normals;   ///< Of any length; one without a direction is none.
  std::vector<Index> corners;  ///< For each of Faces::corners() its normal, or no_index; or empty.
};

/// The edges at both of whose ends its two faces have different normals: a modeller's hard edges.
/// Sorted. None of pieces that are shaded flat: there normals only repeat the shape. A piece counts
/// as that if nearly all of its faces have one normal each, and nearly all split edges have an
/// angle, and most edges with an angle are split.
std::vector<std::array<Index, 2>> split_edges(const Mesh& mesh, const CornerNormals& given,
                                              const Context& context = Context());

}  // namespace meshgrain
