#pragma once

#include "finish/placement.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Moves free vertices a little off the surface, along its normal, so that the faces lie on both
/// sides of it alike: vertices on the surface would leave whole faces inside of what is convex.
/// `share` is how much of the way they go. Where that would spoil a face its vertices stay.
void lift_vertices(Extraction& extraction, const VertexFaces& around, const Placement& placement,
                   double share, const Context& context);

}  // namespace meshgrain
