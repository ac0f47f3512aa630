#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meshgrain/alignment.h"
#include "meshgrain/context.h"
#include "meshgrain/features.h"
#include "meshgrain/fields.h"
#include "meshgrain/graph.h"
#include "meshgrain/guides.h"
#include "meshgrain/mesh.h"
#include "meshgrain/sizing.h"
#include "meshgrain/symmetry.h"

namespace meshgrain {

enum class OutputFaces {
  quads,  ///< Nothing but quads: a quad-dominant mesh of double edge length, subdivided once.
  quad_dominant,  ///< Quads with some triangles and pentagons.
  triangles,
  hexagons,  ///< The dual of triangles.
};

struct RemeshOptions {
  OutputFaces faces = OutputFaces::quads;
  int rosy = 0;  ///< 1, 2, 4 or 6; 0: 6 for triangles and hexagons, else 4.

  /// How fine the written mesh is to be: the first of these that is not zero. Counts are met within
  /// one percent. If all are zero, the mesh has about a sixteenth of the input's vertices, but 500
  /// at least.
  double edge_length = 0;  ///< In input units.
  std::size_t face_count = 0;
  std::size_t vertex_count = 0;

  Sizing sizing;  ///< Where faces are to be smaller than elsewhere.
  GraphOptions graph;
  SolverOptions solver;
  OrientationEnergy orientation_energy = OrientationEnergy::extrinsic;
  PositionEnergy position_energy = PositionEnergy::extrinsic;
  FeatureOptions features;  ///< Of meshes: lines that edges follow.
  /// Curves that edges follow; of point clouds and graphs of faces, that fields are drawn to.
  std::vector<Guide> guides;
  /// From 0, the best shapes, to 1, the fewest irregular vertices: hardly more than the orientation
  /// field has singularities.
  double regularity = 0.5;
  /// Whether pure quads may have a lattice as fine as they are where creases are close to each
  /// other or limbs thin, so that these may be a single quad wide, where there are many holes,
  /// handles or pieces, or where ends would be missed; else every cell becomes four quads.
  bool fine_lattice = true;
  /// Whether edges of large meshes that are far shorter than the target needs are collapsed first,
  /// and points of clouds that are far closer replaced by their means (not with `fields`).
  bool coarsen = true;
  /// Of meshes. One half is remeshed, without `fine_lattice`, and its mirror image added;
  /// RemeshResult::fields are those of the half. An input that is not symmetric within one percent
  /// of its diagonal stays whole.
  Symmetry symmetry;
  CurvatureAlignment curvature;
  int smoothing = 32;     ///< Iterations of smooth() (0: only put onto the surface).
  bool manifold = false;  ///< Drop what is not manifold.
  /// Of meshes: the border's vertices stay exactly where they are, and its edges as they are, so
  /// that the result can be sewn to what lay beside the input. Edges more than two faces long are
  /// divided, with a note, where faces that meet them would be inverted or pass through each other.
  bool lock_borders = false;
  /// Leave out pieces of a mesh that have room for fewer faces than this. Others come back coarse,
  /// but closed where they were.
  double min_component = 0;

  /// Use these instead of solving for an orientation field (and a position field, if that has
  /// points). Values are taken from the nearest node, so the surfaces need not be the same.
  const Fields* fields = nullptr;

  /// Whether others are made, and the best kept, where faces turn out to have faults. That takes
  /// several times as long, and as much memory: without, the first ones are mended as far as can
  /// be.
  bool retries = true;

  /// Bytes that a program which only remeshes this may have in memory, at its peak. What may take
  /// more is refused at once, by an estimate that is rather too high than too low, and leaves out
  /// whatever else the program holds. With a limit no copy of the input is kept that its seams
  /// could be joined in, and if it leaves no room for `retries` there are none. 0: no limit.
  std::size_t memory_limit = 0;

  bool count_singularities = true;  ///< For the report: takes a look at every face.
};

struct StageTime {
  std::string name;
  double seconds = 0;
};

struct RemeshReport {
  std::vector<StageTime> stages;
  std::vector<std::string> notes;  ///< What was mended, left out or missed, a line each.
  std::size_t input_vertices = 0, input_faces = 0;
  std::size_t nodes = 0, edges = 0, levels = 0;
  double edge_length = 0;  ///< Of the position field's lattice, in the mean: of pure quads mostly
                           ///< twice that of their edges.
  std::optional<std::size_t> orientation_singularities, position_singularities;  ///< Meshes only.
  std::vector<EnergyRecord> orientation_energies, position_energies;
};

struct RemeshResult {
  Mesh mesh;
  Fields fields;
  RemeshReport report;
};

/// From mesh (or point cloud) to mesh. Throws Error if the input has no surface, or if options
/// contradict each other or its memory would exceed the limit.
RemeshResult remesh(Mesh input, const RemeshOptions& options = {},
                    const Context& context = Context());

/// Several sizes of one mesh, a result for each of `face_counts` (at least one, all positive; the
/// numbers in `options` are not used), in their order. Cleaning, graph, hierarchy and orientation
/// field are made once, fine enough for the largest, so that the meshes follow the same directions;
/// but a mesh with flaws may get a field that starts elsewhere. What needs another surface, such as
/// one with narrow tunnels closed, is only done by remesh().
/// A piece is left out of all (RemeshOptions::min_component) if it is small for the largest.
/// RemeshResult::fields are left empty. Throws Error as remesh() does, and for a symmetry or a
/// given position field.
std::vector<RemeshResult> remesh_levels(Mesh input, std::span<const std::size_t> face_counts,
                                        RemeshOptions options = {},
                                        const Context& context = Context());

}  // namespace meshgrain
