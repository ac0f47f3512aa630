#pragma once

#include <array>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

using Triangle = std::array<Index, 3>;

/// The faces as triangles, in their order: a quad along the diagonal whose two triangles face the
/// same side, the shorter one if both do; a larger polygon as a fan from its first corner, or by
/// its ears if that would fold; n corners give n - 2 triangles. Empty for a point cloud.
std::vector<Triangle> triangles_of(const Mesh& mesh);

}  // namespace meshgrain
