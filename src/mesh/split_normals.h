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
/// Sorted. None of pieces where angles tell which edges are split, as in flat shading (all) or
/// where a program split what is sharper than some angle: there normals only repeat the shape. But
/// if the split edges are 20 degrees or sharper, and no smooth ones are nearly as sharp, they
/// count.
std::vector<std::array<Index, 2>> split_edges(const Mesh& mesh, const CornerNormals& given,
                                              const Context& context = Context());

}  // namespace meshgrain
