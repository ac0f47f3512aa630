#pragma once

#include <vector>

#include "meshgrain/features.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// Constraints that align both fields with feature lines (section 3.7): for the vertices of each
/// line, its direction there, and the line itself for positions; corners get a lattice point.
struct FeatureConstraints {
  std::vector<OrientationConstraint> orientation;
  std::vector<PositionConstraint> position;
};
FeatureConstraints feature_constraints(const FeatureLines& lines);

struct CurvatureAlignment {
  /// Pull towards the principal directions at every node where they differ, 0 (none) to 1: the soft
  /// constraint of Knöppel et al. 2013.
  float strength = 0;
  /// Hold the field fast where the surface bends by at least this much more one way than the other
  /// over one edge length, in degrees: the hard constraint of Bommes et al. 2009. 0: none.
  float hard_degrees = 0;
  /// Pull along bends that are sharp over one edge length, such as the rims of thin parts, 0 (none)
  /// to 1; what bends less is left to the energy. Of meshes.
  float bends = 0.5f;
};

std::vector<OrientationConstraint> curvature_constraints(const Graph& graph, float edge_length,
                                                         const CurvatureAlignment& alignment,
                                                         const Context& context = Context());

}  // namespace meshgrain
