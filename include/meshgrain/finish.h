#pragma once

#include "meshgrain/context.h"
#include "meshgrain/extract.h"
#include "meshgrain/features.h"
#include "meshgrain/graph.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Splits every face with n corners into n quads, at its centre and the middles of its edges: the
/// connectivity of one Catmull-Clark step. The faces are then four times as many.
void split_into_quads(Extraction& extraction);

/// Replaces a triangle mesh by its dual: one hexagon around each inner vertex of valence six. Faces
/// of the border are left out.
void take_dual(Extraction& extraction);

/// Makes every vertex and edge manifold: faces that would be the third on an edge, or run along it
/// the wrong way, are dropped, and a vertex where several fans of faces meet becomes one a fan.
/// Returns the number of faces dropped.
std::size_t make_manifold(Extraction& extraction);

struct SmoothOptions {
  int iterations = 32;  ///< Small meshes get more, with shorter steps.
  /// Over how many of them steps gain their full momentum. With all of it from the first, longest
  /// steps on, thin limbs of few faces can swing through themselves.
  int slow_start = 0;
  /// How strongly faces are drawn to one size, 0 to 1: areas become more even, angles a little
  /// less.
  double evenness = 0.65;
  /// The lines that Extraction::line_edges follow; without any, those of the surface's border.
  const FeatureLines* features = nullptr;
  EdgeLength relative_size{1.0f};  ///< Relative to each other: one, or one a node of the graph.
  /// From 0 to 1: how far vertices go in the end so that the faces between them are nearer to the
  /// surface, towards its ridges and a little off it.
  double fit = 0;
  /// The mesh is only meant to cover a part of the surface, and changes little: no vertex is held
  /// out at the ends of the surface, faces that pass through each other are not parted, and none is
  /// brought off another side of it. Its corners, its rim among them, stay exactly where they are.
  bool is_part = false;
  /// Faces that are still bad once each vertex was tried are mended together with those around
  /// them, which takes long.
  bool mends_places = true;
  /// Corners stay even where the faces around them are bad.
  bool corners_stay = false;
  /// And so do all vertices on lines, but those of the border.
  bool creases_stay = false;
};

/// Evens the faces out: each iteration moves every vertex to the mean of where it would be in the
/// regular polygons that fit its faces best, and back onto the surface. Vertices on feature lines
/// move along these, and the ones at corners stay. Where a finger or horn of the surface would be
/// left bare by more than an edge length there, a vertex is held out there. At the end single faces
/// that are turned over, nearly degenerate, or pass through others are mended, however many
/// iterations there were (unless none). `surface` is the triangle mesh or point cloud that `graph`
/// was built on.
void smooth(Extraction& extraction, const Mesh& surface, const Graph& graph,
            const SmoothOptions& options = {}, const Context& context = Context());

}  // namespace meshgrain
