#pragma once

#include "meshgrain/extract.h"

namespace meshgrain {

// Manifold meshes stay so; others are left alone.

/// Takes up to `count` times a face away from a mesh of quads (closing one, whose opposite corners
/// become one vertex), or two from a mesh of triangles (contracting an edge): first where that
/// leaves fewer irregular vertices, then where it leaves as many, as beside a dislocation. Returns
/// how often it did.
std::size_t remove_single_faces(Extraction& extraction, int posy, std::size_t count,
                                const Context& context);

/// The opposite, for quads: cuts up to `count` vertices in two, with another quad in between.
std::size_t add_single_quads(Extraction& extraction, std::size_t count, const Context& context);

}  // namespace meshgrain
