#pragma once

#include <vector>

#include "cloud/nearest_neighbors.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// One unit normal a point of a cloud: its own; where it has none, or zero as a placeholder, an
/// estimate (estimate_normals()) that looks the way those given nearby do.
std::vector<Vec3> cloud_normals(const Mesh& cloud, const Neighborhoods& nearest,
                                const Context& context);

}  // namespace meshgrain
