#pragma once

#include "mesh/vertex_faces.h"
#include "meshgrain/finish.h"

namespace meshgrain {

/// Mends what no vertex can by moving: quads that smooth() leaves with a scaled Jacobian below 0.1,
/// as an edge is missing there, or more edges meet than there is room for. An edge of such a quad
/// is turned, or it is closed, or one beside it: two opposite corners become one vertex; in a piece
/// of the mesh, which is then smoothed again while its rim stays. That is kept only if fewer quads
/// are bad and no more faces pass through each other. Topology and borders stay, and features, but
/// that vertices of quads that are still bad in the end may leave them. Whatever is not manifold is
/// left alone.
///
/// `smoothing`: what the mesh was smoothed with. At most `most` faces go.
void close_bad_quads(Extraction& extraction, const Mesh& surface, const VertexFaces& around_surface,
                     const Graph& graph, SmoothOptions smoothing, std::size_t most,
                     const Context& context);

}  // namespace meshgrain
