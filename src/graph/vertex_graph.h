#pragma once

#include "mesh/vertex_faces.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// build_graph() of the vertices of a triangle mesh whose faces around them are known.
Graph vertex_graph(const Mesh& mesh, const VertexFaces& around, const GraphOptions& options,
                   const Context& context);

}  // namespace meshgrain
