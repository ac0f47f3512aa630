#pragma once

#include <span>

#include "extract/clusters.h"
#include "extract/jump_map.h"
#include "meshgrain/features.h"

namespace meshgrain {

/// What a triangle mesh shrinks to when all of its edges with zero jump are collapsed.
struct CollapsedMesh {
  JumpMap lattice;
  Clusters clusters;         // of the vertices
  std::vector<Index> roots;  // the node whose frame is that of the vertex
  /// Pairs of clusters that share vertices of the surface, at which it was cut: how many, and
  /// whether one is on an edge between more than two faces.
  struct Meeting {
    Index a, b, count;
    bool along_edge;
  };
  std::vector<Meeting> meetings;
};

/// Collapses the edges of the mesh itself, shortest first, where their jump is zero and the link
/// condition holds (Dey et al. 1999): the result has the components, borders and genus of the
/// input, whatever the fields are. What is not manifold is cut first. Lines of features collapse
/// only along themselves, so that each stays a chain of edges. `surface` is the triangle mesh whose
/// vertices are the graph's nodes, `sources` what these were before it was cut
/// (ExtractOptions::sources).
CollapsedMesh collapse_mesh(const Mesh& surface, std::span<const Index> sources,
                            const FeatureLines& features, const Graph& graph,
                            const OrientationField& orientation, const PositionField& position,
                            PositionEnergy energy, const Context& context);

}  // namespace meshgrain
