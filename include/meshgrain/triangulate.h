#pragma once

#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Splits polygons into triangles on the same vertices; faces of fewer than three corners are left
/// out. Quads are split along the diagonal whose triangles agree in orientation, or the shorter one
/// if both do; larger polygons by clipping ears in the polygon's mean plane, those with the
/// shortest diagonals first. No diagonal repeats an edge or another diagonal as long as there is
/// another choice, since that would make a non-manifold edge: neighbouring polygons can share so
/// many vertices that plain fans do. A polygon may come to a vertex again, as around a hole;
/// triangles that would repeat one are left out. `face_of_triangle`, if wanted, gets the polygon of
/// each triangle. Takes time linear in the mesh, but within one polygon its corners times its
/// reflex ones, and more often than once where it passes through itself.
Mesh triangulate(const Mesh& polygons, std::vector<Index>* face_of_triangle = nullptr);

}  // namespace meshgrain
