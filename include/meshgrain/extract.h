#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/features.h"
#include "meshgrain/fields.h"

namespace meshgrain {

struct ExtractOptions {
  /// How the integer jumps across edges are found: that of the position field's solver.
  PositionEnergy energy = PositionEnergy::extrinsic;
  /// The triangle mesh whose vertices are the graph's nodes, if there is one: its own edges are
  /// then collapsed, and the output has its components, borders and genus. Without it the paper's
  /// way is taken, which needs nothing but the graph; the last two options are for that.
  const Mesh* surface = nullptr;
  /// Over a mesh: the lines of `surface` that become chains of edges, whatever the fields are; if
  /// there are none given, those of its border.
  const FeatureLines* features = nullptr;
  /// Over a mesh: of each vertex of `surface`, the one that it was before copies were made of some,
  /// to cut the surface where it is not manifold. Vertices that were one come together again.
  std::vector<Index> sources;
  /// Over a mesh: leave the pieces apart that non-manifold edges and vertices of `surface` join.
  bool manifold = false;
  /// Over a mesh: how much shape may be given up for each irregular vertex that goes away, as a sum
  /// over edges of squared changes, in edge lengths, and over the faces that these spoil. 0: none;
  /// infinity: all position singularities go.
  double cancelling_cost = 8;
  /// The same where the target edge length varies: rows must end there, each at a pair of irregular
  /// vertices.
  double cancelling_cost_where_graded = 3;
  /// Over a mesh: where all position singularities stay, a flag a node; empty: nowhere.
  std::vector<std::uint8_t> keeps_singularities;
  /// Over a mesh, for a 4-PoSy: quads alone. Triangles and pentagons go in pairs, with a row of
  /// quads more between the two.
  bool only_quads = false;
  /// Edges of the graph that lie on the border of the surface: where the output is open. Without
  /// any, gaps that the walk leaves are closed.
  std::vector<std::array<Index, 2>> border;
  /// Gaps with more edges than this stay open even away from the border: a point cloud may have
  /// holes that only it knows of.
  std::size_t largest_filled_gap = 64;
};

/// An edge of a mesh that follows a feature line.
struct LineEdge {
  Index a, b, line;
};

struct Extraction {
  Mesh mesh;
  std::vector<Index> nodes;  ///< For each vertex, the node of its cluster that lies nearest to it.
  std::vector<LineEdge> line_edges;
  std::vector<Index> corners;  ///< Vertices at corners of the lines, whose nodes these are.
};

/// Reads a mesh off the integer jumps of a position field (section 3.8): quads with some triangles
/// and pentagons for a 4-PoSy, triangles for a 6-PoSy. The fields may come from anywhere; only
/// their integers relative to the graph matter.
Extraction extract_mesh(const Graph& graph, const OrientationField& orientation,
                        const PositionField& position, const ExtractOptions& options = {},
                        const Context& context = Context());

}  // namespace meshgrain
