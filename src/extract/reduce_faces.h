#pragma once

#include "meshgrain/extract.h"

namespace meshgrain {

/// Takes up to `count` times a face away from a mesh of quads (closing one, whose opposite corners
/// become one vertex), or two from a mesh of triangles (contracting an edge): first where that
/// leaves fewer irregular vertices, then where it leaves as many, as beside a dislocation. Manifold
/// meshes stay so; others are left alone. Returns how often it did.
std::size_t reduce_faces(Extraction& extraction, int posy, std::size_t count,
                         const Context& context);

}  // namespace meshgrain
