#pragma once

#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/features.h"
#include "meshgrain/hierarchy.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// How strongly the surface bends at each node: the norm of the second fundamental form,
/// sqrt(kmin² + kmax²), where the form is a mean over a patch of about `area`. What bends to and
/// fro within a patch, as noise does, adds up to little; a finger, however thin, does not.
///
/// On a mesh whose vertices are the nodes, a patch's form is the sum over its edges of the angle
/// between the faces, times the length (Cohen-Steiner and Morvan 2003): right for fine and coarse
/// triangles alike, and edges on the lines of `creases` are left out. Other graphs take that of
/// estimate_curvature().
std::vector<float> bending(const Hierarchy& hierarchy, const Mesh& surface,
                           const FeatureLines& creases, double area, const Context& context);

}  // namespace meshgrain
