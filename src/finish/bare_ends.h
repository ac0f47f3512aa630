#pragma once

#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/extract.h"
#include "meshgrain/fields.h"
#include "meshgrain/graph.h"

namespace meshgrain {

/// A vertex of the mesh that should reach farther out, and where to.
struct Reach {
  Index vertex;
  Index node;  ///< The nearest one of the surface.
  Vec3 position;
  Vec3 tip;
  float radius;  ///< How near to the tip it should stay.
};

/// Where fingers, horns and ears of the surface stick out of the mesh by more than `reach` (one for
/// all nodes, or one a node): the vertex nearest to each tip, and the node on the way there from
/// which the tip is that far away. `graph` is that of the surface's vertices, and `around` holds
/// the faces of the mesh.
std::vector<Reach> find_bare_ends(const Extraction& extraction, const VertexFaces& around,
                                  const Graph& graph, const EdgeLength& reach,
                                  const Context& context);

/// The nodes that the mesh leaves bare: no vertex is within `reach` of them on their side of the
/// surface, and no face within three quarters of it.
std::vector<Index> find_bare_nodes(const Extraction& extraction, const VertexFaces& around,
                                   const Graph& graph, const EdgeLength& reach,
                                   const Context& context);

}  // namespace meshgrain
