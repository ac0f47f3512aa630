#pragma once

#include <functional>

#include "finish/chords.h"
#include "mesh/vertex_faces.h"

namespace meshgrain {

/// Makes closed chains follow their lines around, and tells `chords` the order. Where they come
/// around, single vertices that are out of order go between their neighbours. Where they do not, or
/// with a gap of nearly half of the line, all are spread over it evenly: on a small circle, an edge
/// that should go the long way around would stay on the wrong side. `upward`: the normal of the
/// surface where a vertex is.
void go_around(Mesh& mesh, const VertexFaces& around, const std::function<Vec3(Index)>& upward,
               Chords& chords, Rails& rails);

}  // namespace meshgrain
