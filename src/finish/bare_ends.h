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

/// Finds where fingers, horns and ears of the surface stick out of a mesh, again and again while
/// the mesh moves.
class BareEnds {
 public:
  /// `graph` is that of the surface's vertices, and `around` holds the faces of the mesh; all must
  /// outlive this.
  BareEnds(const Extraction& extraction, const VertexFaces& around, const Graph& graph,
           const Context& context);

  /// Those that stick out by more than `reach` (one for all nodes, or one a node): the vertex
  /// nearest to each tip, and the node on the way there from which the tip is that far away.
  std::vector<Reach> find(const EdgeLength& reach);

 private:
  /// The nodes that have no vertex within reach on their side of the surface.
  std::vector<Index> not_reached(const EdgeLength& reach);
  void find_ways(const std::vector<Index>& bare);

  const Extraction& extraction_;
  const VertexFaces& around_;
  const Graph& graph_;
  const Context& context_;
  // Of each node:
  std::vector<Index> vertex_;  // one that reaches it, or did; of those to which ways go the nearest
  std::vector<float> length_;  // of the way; 0 where none is needed
  std::vector<Index> before_;  // the node before on the way, or no_index
};

}  // namespace meshgrain
