#pragma once

#include <span>
#include <vector>

#include "cloud/nearest_neighbors.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The mean squared distance of each point to its neighbours; 0 if it has none.
std::vector<float> squared_distances(std::span<const Vec3> points, const Neighborhoods& nearest,
                                     const Context& context);

/// Of some of them, evenly chosen; 0 if there are none.
float median(std::span<const float> values);

/// Of evenly scattered points, as many as there are a unit of area, the j-th nearest lies at a mean
/// squared distance of j / (pi density): all of them together tell the area of one.
inline float area_of_point(float squared_distance, std::size_t neighbors) {
  return 3.14159265f * 2 * squared_distance / static_cast<float>(neighbors + 1);
}

}  // namespace meshgrain
