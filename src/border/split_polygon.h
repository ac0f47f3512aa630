#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// What a polygon may be split into, and how good each part would be.
struct PolygonParts {
  std::size_t most_corners = 4;  ///< Of a part: 3 to 5.
  /// Of the part with these corners, as places in the polygon, in order.
  std::function<double(std::span<const std::size_t>)> cost;
  /// Whether two corners that are not beside each other may be joined.
  std::function<bool(std::size_t, std::size_t)> may_join;
};

/// The parts of least cost that chords split a polygon of `count` corners into, by dynamic
/// programming; none if there is no way. Takes the fourth power of `count`, or the fifth.
std::vector<std::vector<std::size_t>> split_polygon(std::size_t count, const PolygonParts& parts);

}  // namespace meshgrain
