#pragma once

#include "meshgrain/fields.h"

namespace meshgrain {

/// How the target edge length varies over the surface (Figure 22).
struct Sizing {
  enum class Kind {
    uniform,
    curvature,  ///< Smaller where the surface bends: by up to `ratio`.
    distance,   ///< From 1 / `ratio` at `point` to 1 at the far end of the surface.
    values,     ///< Proportional to the mesh's value at each vertex (Mesh::values, positive).
  };
  Kind kind = Kind::uniform;
  float ratio = 4;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< In input coordinates.
};

/// Relative edge lengths for the nodes of a graph, evened out so that neighbours differ little; one
/// value if the sizing is uniform. `edge_length` is the mean that the curvature is measured
/// against, and `point` is relative to the graph's positions. Throws Error if values are wanted and
/// missing or not positive.
EdgeLength relative_edge_lengths(const Graph& graph, const Sizing& sizing,
                                 const std::vector<float>& values, double edge_length,
                                 const Context& context = Context());

/// The factor that makes the relative lengths `relative` give faces of `face_area` edge lengths
/// squared, `count` in all.
double length_for_count(const Graph& graph, const EdgeLength& relative, double face_area,
                        double count);

EdgeLength scaled(const EdgeLength& lengths, double factor);

}  // namespace meshgrain
