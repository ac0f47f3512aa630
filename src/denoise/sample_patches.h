#pragma once

#include <cstddef>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Connected patches of about `size` faces from all over a mesh, `count` of them, as a mesh of
/// their own; the whole of it if it is not larger than that.
Mesh sample_patches(const Mesh& mesh, std::size_t count, std::size_t size, const Context& context);

}  // namespace meshgrain
