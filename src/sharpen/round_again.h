#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Puts those vertices of a mesh that was made where roundings had been sharpened back onto these.
/// `roundings` are what sharpen_bends() returned, or several such meshes in one. The border stays,
/// and so do vertices whose faces would be spoilt, and all where more faces than before would pass
/// through each other.
void round_again(Mesh& mesh, const Mesh& roundings, const Context& context);

/// The triangles of another mesh, too, with their vertices and `values`.
void add_triangles(Mesh& roundings, const Mesh& more);

}  // namespace meshgrain
