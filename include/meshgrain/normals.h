#pragma once

#include <cstddef>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// One unit normal a vertex: the normals of the adjacent faces weighted by their angle at the
/// vertex (Thürmer and Wüthrich 1998), which no other triangulation of the same surface would
/// change. Takes polygons, with Newell normals. Faces without a normal (thinner than the rounding
/// of their coordinates) contribute nothing; a vertex with no other faces takes the normal of the
/// vertex next to it, and (0, 0, 1) if there is none.
///
/// A vertex of a crease, an edge whose faces' normals differ by more than `crease_degrees` (below
/// 0: off), gets the normal of one adjacent face instead, as an average would round the crease off
/// (paper section 3.5): that with the largest angle at the vertex, the first of equals, so that the
/// choice follows the shape rather than the order of the faces.
std::vector<Vec3> vertex_normals(const Mesh& mesh, double crease_degrees = -1,
                                 const Context& context = Context());

/// One unit normal a point of a cloud (faces are ignored): that of the plane of least squares
/// through the point and its `k` nearest neighbours, nearer ones weighing more. The normals agree
/// over each connected part of the neighbour graph and point outwards for the part as a whole
/// (after Hoppe et al. 1992; see src/cloud/orient_normals.cpp). Parts without neighbours get any
/// unit vector.
std::vector<Vec3> estimate_normals(const Mesh& cloud, std::size_t k = 16,
                                   const Context& context = Context());

}  // namespace meshgrain
