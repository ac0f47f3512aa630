#pragma once

#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/features.h"
#include "meshgrain/fields.h"
#include "meshgrain/hierarchy.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Pulls orientations along the axis about which the surface bends, where it bends sharply over an
/// edge of the output: along the rims of thin parts. Faces that cross such a bend askew cut notches
/// into it, and the energies of neighbouring normals, which hardly tell one direction from another
/// there, do not prevent it.
///
/// The constraints are soft, up to `strength` (0 to 1; 0: none). None is where the surface bends
/// gently or alike in all directions, or on lines of `creases`; nor where the nodes of the
/// hierarchy are not the vertices of the surface, the faces `around` which are known.
std::vector<OrientationConstraint> bend_constraints(const Hierarchy& hierarchy, const Mesh& surface,
                                                    const VertexFaces& around,
                                                    const FeatureLines& creases, float edge_length,
                                                    float strength, const Context& context);

}  // namespace meshgrain
