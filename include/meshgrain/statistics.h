#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The columns of the paper's Table 1 and what else tells a good mesh. Areas are relative to the
/// mean area, angles in degrees. A face that is not flat has the least of the areas of its
/// triangulations (all of a quad's, a larger polygon's fan), and its angles are those between its
/// edges, above 180 where a corner of a quad or polygon is reflex.
struct MeshStatistics {
  /// All vertices, isolated ones too; faces by their number of corners.
  std::size_t vertices = 0, faces = 0, triangles = 0, quads = 0, larger = 0;
  /// Not on a border and without the regular number of neighbours: 6 if more than 90 % of the faces
  /// are triangles, 3 if more than half are hexagons, else 4.
  std::size_t irregular_vertices = 0;
  /// Irregular vertices, and faces other than the prevailing kind: in a quad mesh, each of these
  /// counts as the irregular vertex that it becomes when the mesh is subdivided into quads.
  std::size_t singularities = 0;
  double area_sigma = 0, area_min = 0, area_max = 0;
  double angle_sigma = 0;  ///< About the regular polygon's angle of each face.
  double angle_min = 0, angle_max = 0;
  double angle_min_mean = 0, angle_max_mean = 0;  ///< Means of each face's least and most angle.
  double edge_mean = 0, edge_sigma = 0;           ///< In input units; relative to the mean.
  std::size_t inverted_quads = 0;                 ///< With a corner of 180 degrees or more.
  /// Of all quads, the least sine of the corners as seen along the quad's normal (its scaled
  /// Jacobian): the least of these, and what 99 % of the quads exceed; 0 if there are none.
  double jacobian_min = 0, jacobian_p01 = 0;
  std::size_t components = 0, boundary_loops = 0;
  std::size_t non_manifold_edges = 0;     ///< With more than two faces.
  std::size_t non_manifold_vertices = 0;  ///< Whose faces are more than one fan.
  std::size_t isolated_vertices = 0;      ///< Without a face; in no number but `vertices`.
  std::size_t marked_edges = 0;           ///< Of Mesh::marked_edges, those that faces have.
  long euler = 0;                         ///< Vertices (but isolated ones) - edges + faces.
};

MeshStatistics mesh_statistics(const Mesh& mesh);

/// All pairs of faces that pass through each other, the lower number first, in increasing order. A
/// quad counts with both of its diagonals; faces that share an edge, or touch, do not.
std::vector<std::array<Index, 2>> find_crossings(const Mesh& mesh,
                                                 const Context& context = Context());

/// Distances from points sampled on one surface to another.
struct SurfaceDistance {
  double mean = 0, max = 0;
};

/// Of `samples` area-uniform points of `from` (of a point cloud: at most so many of its vertices)
/// to the nearest point of `to`, divided by `reference_length` (the input's bounding-box diagonal,
/// by custom). Both origins are taken into account. Throws Error if a mesh is empty or the
/// reference length is not positive.
SurfaceDistance surface_distance(const Mesh& from, const Mesh& to, double reference_length,
                                 std::size_t samples = 100000, const Context& context = Context());

/// How much of the lines of one surface the edges of another follow.
struct KeptLines {
  /// Shares of the length of creases and border that edges of the same kind follow: creases within
  /// a tenth of an edge and 20 degrees, and at least half as sharp; the border, which is ragged on
  /// scans, within a fifth of an edge. Absent where there are none.
  std::optional<double> creases, border;
  /// Where creases meet or turn by more than 40 degrees, and how many have a vertex as near.
  std::size_t corners = 0, corners_kept = 0;
};

/// Creases are edges between faces whose normals differ by more than `crease_degrees`.
KeptLines kept_lines(const Mesh& input, const Mesh& output, double crease_degrees = 40);

/// Length of the diagonal of the bounding box of the vertices that faces use (all, for a cloud).
double bounding_diagonal(const Mesh& mesh);

}  // namespace meshgrain
