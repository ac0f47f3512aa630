#pragma once

#include "meshgrain/features.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// How the target edge length varies over the surface (Figure 22).
struct Sizing {
  enum class Kind {
    uniform,
    distance,  ///< From 1 / `ratio` at `point` to 1 at the far end of the surface.
    values,    ///< Proportional to the mesh's value at each vertex (Mesh::values, positive).
    density,   ///< So that faces per area are proportional to those values.
    /// By paint (ReadOptions::paint): from 1 / sqrt(`ratio`) where the value is 1 to sqrt(`ratio`)
    /// where it is -1. With a ratio of 4, red has four times as many faces as white, and cyan a
    /// quarter.
    paint,
  };
  Kind kind = Kind::uniform;
  /// From 0 to 1: how much smaller faces are where the surface bends. At 1 they are as the least
  /// mean distance to the surface wants them. Multiplies what `kind` says.
  double adaptive = 0;
  /// The longest edge length to the shortest, by distance or paint, and at most by bending.
  float ratio = 4;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< In input coordinates.
  /// Lengths grow at most by this factor over three faces.
  double grading = 2;

  /// Whether the mesh's values are read.
  bool is_by_value() const { return kind != Kind::uniform && kind != Kind::distance; }
  bool is_uniform() const { return kind == Kind::uniform && adaptive == 0; }
};

/// Throws Error if a number makes no sense: a ratio below 1, an adaptivity that is not between 0
/// and 1, a grading that is not larger than 1, or a point that is not finite.
void check(const Sizing& sizing);

/// Relative edge lengths for the nodes of a hierarchy's finest graph: shorter around small turns of
/// `creases`, whatever the sizing; one value if it is uniform and there are none. The graph is that
/// of `surface` (Mesh::values are read), whose bending does not count at `creases`, and `face_side`
/// is the mean side of the faces that are wanted. `point` is relative to the graph's positions.
/// Throws Error if values are wanted and missing or not positive, and as check() does.
EdgeLength relative_edge_lengths(const Hierarchy& hierarchy, const Mesh& surface,
                                 const FeatureLines& creases, const Sizing& sizing,
                                 double face_side, const Context& context = Context());

/// The largest lengths that are nowhere longer than `lengths`, and differ between neighbours by at
/// most `growth` times their distance.
EdgeLength graded(const Graph& graph, const EdgeLength& lengths, double growth,
                  const Context& context = Context());

/// The factor that makes the relative lengths `relative` give faces of `face_area` edge lengths
/// squared, `count` in all.
double length_for_count(const Graph& graph, const EdgeLength& relative, double face_area,
                        double count);

EdgeLength scaled(const EdgeLength& lengths, double factor);

}  // namespace meshgrain
