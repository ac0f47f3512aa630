#pragma once

#include <cstddef>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The columns of the paper's Table 1 and what else tells a good mesh. Areas are relative to the
/// mean area, angles in degrees.
struct MeshStatistics {
  std::size_t vertices = 0, faces = 0, triangles = 0, quads = 0, larger = 0;
  std::size_t irregular_vertices = 0;  ///< Interior; regular is 6 neighbours if triangles prevail, else 4.
  std::size_t singularities = 0;       ///< Irregular vertices and faces other than the ideal one.
  double area_sigma = 0, area_min = 0, area_max = 0;
  double angle_sigma = 0;  ///< About the regular polygon's angle of each face.
  double angle_min = 0, angle_max = 0;
  double angle_min_mean = 0, angle_max_mean = 0;  ///< Means of each face's least and most angle.
  double edge_mean = 0, edge_sigma = 0;           ///< In input units; relative to the mean.
  std::size_t inverted_quads = 0;
  std::size_t components = 0, boundary_loops = 0;
  std::size_t non_manifold_edges = 0, non_manifold_vertices = 0, isolated_vertices = 0;
  long euler = 0;
};

MeshStatistics mesh_statistics(const Mesh& mesh);

/// Distances from points sampled on one surface to another.
struct SurfaceDistance {
  double mean = 0, max = 0;
};

/// Of `samples` area-uniform points of `from` (its vertices if it is a point cloud) to the nearest
/// point of `to`, divided by `reference_length` (the input's bounding-box diagonal, by custom).
SurfaceDistance surface_distance(const Mesh& from, const Mesh& to, double reference_length,
                                 std::size_t samples = 100000);

/// Length of the diagonal of the bounding box of the vertices that faces use (all, for a cloud).
double bounding_diagonal(const Mesh& mesh);

}  // namespace meshgrain
