#pragma once

#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "meshgrain/polylines.h"

namespace meshgrain {

/// The lines of a surface that edges of the output follow: its border, its creases, its marked
/// edges and guides that were cut into it.
struct FeatureLines {
  /// Vertices of the surface, line after line, in the order in which a line runs. Open lines end at
  /// corners; a closed one ends with the vertex that it began with.
  std::vector<Index> vertices;
  std::vector<Index> starts{0};  ///< Lines + 1: where each begins in `vertices`.
  std::vector<Vec3> positions;   ///< Where the line runs: one for each of `vertices`.
  /// For each line, how strongly crosses follow it and how strongly lines of the lattice do, from 0
  /// (not at all) to 1.
  std::vector<float> orient, align;
  /// Vertices where lines end or meet, or turn sharply, and tips of cones, in increasing order:
  /// they stay.
  std::vector<Index> corners;

  std::size_t size() const { return starts.size() - 1; }
  bool empty() const { return vertices.empty(); }
  Index begin(std::size_t line) const { return starts[line]; }
  Index end(std::size_t line) const { return starts[line + 1]; }
  bool is_closed(std::size_t line) const;
};

/// Which edges are creases, beside those that are marked (Mesh::marked_edges).
enum class Creases {
  automatic,  ///< Of mechanical parts: edges clearly sharper than all that are meant to be smooth;
              ///< of parts too rounded to tell these apart, lines of sharp ones as by_angle.
  by_angle,   ///< Edges that are sharp enough; of a sculpture, lines of them that faces can follow.
  marked,     ///< Only edges that are marked (Mesh::marked_edges).
  none,       ///< Not even marked edges.
};

struct FeatureOptions {
  Creases creases = Creases::automatic;
  double crease_degrees = 40;  ///< Creases::by_angle: the least angle between the faces' normals.
  bool align_border = true;    ///< Whether the fields follow the border.
  /// Whether marked edges that run too close to another line for the faces asked for are left out,
  /// as creases are.
  bool marks_may_go = false;
  /// How strongly orientations and positions are held to creases and marked edges. Extrinsic
  /// energies turn to them by themselves, and do better where creases meet at angles that no cross
  /// can follow.
  float orient_creases = 0, align_creases = 1;
};

/// The feature lines of a triangle mesh. Turns of a line count as corners if they are sharp both
/// from edge to edge and over `edge_length`, that of the output. Marked edges that are ragged where
/// the surface is smooth, as where materials meet along the sides of triangles, become lines that
/// run evenly. Tips of cones are not among the corners yet.
FeatureLines find_features(const Mesh& triangles, const FeatureOptions& options, double edge_length,
                           const Context& context = Context());

/// Marks the edges of a mesh along lines that were drawn on it. Each of their points must be where
/// a vertex is, within 0.0001 of the mesh's diagonal. Where an edge joins one to the next it is
/// marked, else the edges of the shortest way between them, of several such ways that nearest to
/// the straight line. Throws Error, which counts points from 1, as the vertices of a file, if there
/// is no such vertex or no way.
void mark_edges(Mesh& mesh, const Polylines& lines, const Context& context = Context());

}  // namespace meshgrain
