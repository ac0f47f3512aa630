#pragma once

#include <cstddef>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Patches of about `size` faces from all over a mesh, `count` of them, each what lies in a ball,
/// as a mesh of their own; the whole of it if it is not larger than that. The patches are shared
/// out by the order of the faces, and found without knowing their neighbours.
Mesh sample_patches(const Mesh& triangles, std::size_t count, std::size_t size,
                    const Context& context);

}  // namespace meshgrain
