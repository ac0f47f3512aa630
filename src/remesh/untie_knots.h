#pragma once

#include "mesh/vertex_faces.h"
#include "meshgrain/finish.h"

namespace meshgrain {

/// Quads alone: finds irregular vertices that lie close together and mostly cancel each other out,
/// as where the lattice was folded, and looks for changes of the quads there that leave fewer
/// (search_knot). These are made in a piece of the mesh, which is smoothed again while its rim
/// stays, and kept if the faces there are no more uneven and askew than `most_worse` times as much
/// as before, and no more of them pass through each other. Topology, borders and features stay.
///
/// `smoothing`: what the mesh was smoothed with. At most `most` faces go.
void untie_knots(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
                 const Graph& graph, SmoothOptions smoothing, std::size_t most, float most_worse,
                 const Context& context);

}  // namespace meshgrain
