#pragma once

#include <span>

#include "cloud/nearest_neighbors.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Turns unit normals of unknown sign so that they agree over each connected part of the symmetric
/// neighbour graph, and point outwards where the part as a whole says what is outside.
void orient_normals(std::span<const Vec3> points, const Neighborhoods& neighborhoods,
                    std::span<Vec3> normals, const Context& context = Context());

}  // namespace meshgrain
