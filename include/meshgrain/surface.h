#pragma once

#include <cstdint>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Area of a face (of its fan's triangles), in squared input units, and of all faces: zero for a
/// point cloud.
double face_area(const Mesh& mesh, std::size_t f);
double surface_area(const Mesh& mesh, const Context& context = Context(1));

/// Of the sides of all faces, in input units: an edge between two faces counts twice in the mean.
struct EdgeLengths {
  double mean = 0, max = 0;
};
EdgeLengths edge_lengths(const Mesh& mesh, const Context& context = Context(1));

/// Splits the edges of a triangle mesh that are longer than `max_length` at their midpoints, again
/// and again until none is left: the surface stays exactly as it is (section 3.8 asks for an input
/// denser than the output). Values and normals are interpolated. Non-manifold edges are ordinary.
void subdivide(Mesh& triangles, double max_length, const Context& context = Context());

/// The same where edges may be as long as the smaller of the numbers at their ends: positive, one a
/// vertex, and interpolated too. Returns whether any edge was longer.
bool subdivide(Mesh& triangles, std::vector<float>& max_lengths,
               const Context& context = Context());

/// In units of the mesh.
struct CoarseEdges {
  float shortest;  ///< Shorter ones are collapsed.
  float longest;   ///< None that is longer is made.
};

/// Collapses the short edges of a triangle mesh, as far as the surface allows it: pieces keep their
/// borders and genus, faces do not turn over, the volume beside each edge stays, and vertices that
/// are not inside of a surface or that are flagged in `stays` (one a vertex) keep their places.
/// Returns which vertices of the mesh that was passed are left, in order.
///
/// Faces are collapsed together that are near each other in memory, as sort_along_curve() puts
/// them: what is at the seams between such runs of faces stays.
///
/// Where the vertex of an edge comes to lie is told by the faces around it alone (memoryless
/// simplification, Lindstrom and Turk 1999), so that nothing is kept of a vertex but its place.
std::vector<Index> coarsen(Mesh& triangles, const CoarseEdges& edges,
                           std::vector<std::uint8_t> stays, const Context& context);

/// Puts vertices into the order of a Hilbert curve, and faces into the order of their first vertex,
/// so that what is near on the surface is near in memory. Returns, for each new vertex, its index
/// in the mesh that was passed.
std::vector<Index> sort_along_curve(Mesh& mesh, const Context& context = Context());

}  // namespace meshgrain
