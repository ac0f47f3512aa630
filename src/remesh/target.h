#pragma once

#include "cloud/thin_out.h"
#include "mesh/surface_size.h"
#include "meshgrain/remesh.h"
#include "meshgrain/surface.h"

namespace meshgrain {

/// The symmetry of the position field that an output needs.
int posy_of(OutputFaces faces);

/// How many vertices the mesh is to have where nothing is asked for: a sixteenth of the input's, as
/// suits scans; but of a mesh of few vertices, such as a part from CAD, enough for its shape, and
/// of a cloud of few points as many as these.
std::size_t default_vertex_count(std::size_t input_vertices, bool is_cloud);

/// Whether the input's edges cannot be split again once the sizes of faces are known: the nodes are
/// its faces, or guides are cut into it.
bool splits_only_once(const RemeshOptions& options);

/// Whether positions are given, which then decide how fine the mesh is.
bool has_given_positions(const RemeshOptions& options);

/// How fine the lattice of the position field must be for the mesh that is to be written.
class Target {
 public:
  Target() = default;
  /// `lattice_faces`: what the cells of the lattice become; for OutputFaces::quads each is four.
  /// Where nothing is asked for, given positions say how fine they are; or, without these,
  /// `default_vertices`. `scale`: input units a unit of the surface.
  Target(const RemeshOptions& options, OutputFaces lattice_faces, std::size_t default_vertices,
         double scale);

  /// The edge length that gives a surface of this area as many lattice cells as are wanted; or the
  /// one asked for.
  double edge_length(double area) const;

  /// The area of one face of the written mesh, if the surface has this area.
  double face_area(double area) const;

  /// Throws Error if a surface of this area would have more faces than can be counted.
  void refuse_too_many(double area) const;

  /// The mean side of the written faces, if the surface has this area: of quads, or of the
  /// triangles that hexagons are dual to.
  double face_side(double area) const;

  /// How long edges of the surface may be that the fields live on, in edges of the lattice.
  double longest_edge() const;

  /// How long edges of the input may be, if the surface has this area and its edges this mean
  /// length: longer ones are split. Where faces vary in size, and nothing can be split later on,
  /// fine enough for the smallest.
  double longest_input_edge(const RemeshOptions& options, double area, double mean_edge) const;

  /// What a cloud of many more points is thinned out to.
  CloudDensity density_of_cloud(const RemeshOptions& options) const;

  /// How far apart neighbouring points of a cloud may lie, if the surface has this area.
  double sparsest_points(const RemeshOptions& options, double area) const;

  /// Between which lengths the edges of a dense surface are to be, of this area.
  CoarseEdges coarse_edges(const RemeshOptions& options, double area) const;

  /// Whether so many vertices or points may be more than are needed.
  bool may_be_dense(const RemeshOptions& options, std::size_t vertices) const;

  /// Whether a mesh of so many vertices and this size has so many more vertices than are needed
  /// that coarsen() pays.
  bool is_dense(const RemeshOptions& options, std::size_t vertices, const SurfaceSize& size) const;

  /// How fast edge lengths may grow with the distance, for faces to grow by the factor `grading`
  /// over three of them.
  double growth(double grading) const;

  /// The edge length at every node of a graph, varying as `relative` does, but at most by `growth`.
  EdgeLength edge_lengths(const Graph& graph, const EdgeLength& relative, double growth,
                          const Context& context) const;

  /// How many faces or vertices a mesh has for one that was asked for; 1 if it went by length. For
  /// pure quads the mesh is the one before it is split.
  double count_ratio(const Mesh& mesh) const;
  /// The same of a finished mesh.
  double finished_ratio(const Mesh& mesh) const;

  /// Whether a count was asked for: not by length, and not by default.
  bool must_be_met() const { return is_asked_for_ && cells_ > 0; }

  /// By which share a count may be off.
  double tolerance() const { return is_asked_for_ ? 0.0095 : 0.05; }
  /// Which share of faces too many may be taken away again: about a row of cells, as one cannot
  /// tell to within less how many there will be.
  double surplus() const;

  /// How often remove_single_faces() must act on a mesh so that it has no more than this share too
  /// many.
  std::size_t faces_to_close(const Mesh& mesh, double tolerance) const;

  /// How many quads, each with a vertex of its own, are to be added to what is written so that it
  /// has no more than the tolerance too few.
  std::size_t missing_quads(const Mesh& mesh) const;

  /// How many faces a finished mesh may lose.
  std::size_t spare_faces(const Mesh& mesh) const;

 private:
  double ratio(std::size_t faces, std::size_t vertices) const;

  double cells_ = 0;      // wanted squares, or pairs of triangles; 0: by length
  double length_ = 0;     // wanted lattice edge length, if by length
  double cell_area_ = 1;  // in squared edge lengths
  double sides_ = 1;      // of faces a lattice edge
  double faces_per_cell_ = 1;
  OutputFaces kind_ = OutputFaces::quads;
  double faces_ = 0, vertices_ = 0;  // wanted; 0 if not what it went by
  bool is_asked_for_ = true;
};

}  // namespace meshgrain
