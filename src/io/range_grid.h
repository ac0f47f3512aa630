#pragma once

#include <cstddef>
#include <span>

#include "meshgrain/mesh.h"

namespace meshgrain::io {

/// Adds the triangles of a range image to `mesh`: `grid` holds row after row of `columns` vertices,
/// or no_index where the scanner saw nothing. Cells of four vertices are split along their shorter
/// diagonal, those of three give one triangle. Triangles with an edge far longer than the usual
/// distance of neighbours in the grid span a step in depth, not a surface, and are left out. Range
/// images are taken along -z: most triangles are made to face +z.
void triangulate_grid(std::span<const Index> grid, std::size_t columns, Mesh& mesh);

}  // namespace meshgrain::io
