#pragma once

#include <span>
#include <vector>

#include "cloud/nearest_neighbors.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Points that belong to no surface: much farther from their neighbours than most points are, and
/// either alone there or scattered to all sides. In increasing order; none if they are so many that
/// the cloud may be meant like that.
std::vector<Index> find_outliers(std::span<const Vec3> points, const Neighborhoods& nearest,
                                 const Context& context);

/// Takes them out of a cloud, and those that only they were near to. Returns their number;
/// `nearest` is then of what is left.
std::size_t drop_outliers(Mesh& cloud, Neighborhoods& nearest, const Context& context);

}  // namespace meshgrain
