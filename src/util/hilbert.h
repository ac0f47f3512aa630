#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The order in which a Hilbert curve through the bounding box visits the points: result[k] is the
/// index of the k-th point. Points in the same cell of the curve keep their order.
std::vector<Index> hilbert_order(std::span<const Vec3> points, const Context& context);

}  // namespace meshgrain
