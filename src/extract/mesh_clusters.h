#pragma once

#include "extract/clusters.h"
#include "extract/polygon_map.h"

namespace meshgrain {

/// What a triangle mesh shrinks to when all of its edges with zero jump are collapsed.
struct CollapsedMesh {
  PolygonMap map;                   // triangles
  Clusters clusters;                // of the vertices of `map` (edges and border left empty)
  std::vector<std::uint8_t> holes;  // for each halfedge of `map`, whether it lies outside
  /// Pairs of clusters that share a vertex of the surface, at which it was cut, with how many.
  struct Meeting {
    Index a, b, count;
  };
  std::vector<Meeting> meetings;
  std::vector<std::array<int, 2>>
      jumps;  // of each edge, in the frame of its even halfedge's origin
};

/// Collapses the edges of the mesh itself, shortest first, where their jump is zero and the link
/// condition holds (Dey et al. 1999): the result has the components, borders and genus of the
/// input, whatever the fields are. What is not manifold is cut first. `surface` is the triangle
/// mesh whose vertices are the graph's nodes.
CollapsedMesh collapse_mesh(const Mesh& surface, const Graph& graph,
                            const OrientationField& orientation, const PositionField& position,
                            PositionEnergy energy, const Context& context);

}  // namespace meshgrain
