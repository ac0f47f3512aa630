#pragma once

#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Brings the faces, not only the vertices, near to the surface. Free vertices go along it to where
/// it bends within their faces, such as onto ridges; then off it a little, so that their faces lie
/// on both sides of it alike: vertices on the surface would leave whole faces inside of what is
/// convex. `share` is how much of the way they go. Where that would spoil a face its vertices stay.
void fit_to_surface(Extraction& extraction, const VertexFaces& around, Placement& placement,
                    double share, const Context& context);

}  // namespace meshgrain
