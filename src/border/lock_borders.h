#pragma once

#include <cstddef>

#include "border/border_loops.h"
#include "meshgrain/extract.h"
#include "meshgrain/graph.h"
#include "meshgrain/remesh.h"

namespace meshgrain {

/// Gives an extracted mesh the borders of its surface: their locked vertices, as corners that stay.
/// Vertices of the extracted borders slide to locked ones; those that are too many are merged, and
/// those that are missing are put in, with the edges that they need. For OutputFaces::quads the
/// mesh is the one that is still to be split, and gets about every second of them. The pieces of a
/// surface that is not manifold must be apart (ExtractOptions::manifold).
void lock_borders(Extraction& extraction, const BorderLoops& borders, const Graph& graph,
                  OutputFaces faces, const Context& context);

/// After the split into quads: the middles of border edges become the other locked vertices.
void lock_middles(Extraction& extraction, const BorderLoops& borders, const Graph& graph);

/// Takes out middles of edges that have no locked vertex, as those of borders with an odd number of
/// edges: each leaves a triangle.
void drop_spare_middles(Extraction& extraction);

/// Divides pairs of faces near locked borders anew where that makes better ones; quads stay quads.
/// Returns whether there were any; a mesh that is not manifold stays as it is.
bool improve_border_faces(Extraction& extraction, OutputFaces faces, const Context& context);

/// Joins the vertices that are one in the surface: where its pieces and borders touch.
void join_locked(Extraction& extraction);

}  // namespace meshgrain
