#pragma once

#include <span>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "meshgrain/symmetry.h"

namespace meshgrain {

// Of meshes that were cut at planes, all of which go through the origin.

/// Whether every edge of the border lies in one of the planes: what was cut had no border.
bool has_border_in_planes_only(const Mesh& mesh, std::span<const MirrorPlane> planes,
                               const Context& context);

/// Moves the vertices of such a border into the planes that are nearest to them, so that nothing
/// stays open between a part and its mirror images; where it goes from one plane to another, the
/// nearer of two vertices into both.
void put_border_into_planes(Mesh& mesh, std::span<const MirrorPlane> planes,
                            const Context& context);

}  // namespace meshgrain
