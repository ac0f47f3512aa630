#include "io/range_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <vector>

namespace meshgrain::io {
namespace {

/// Edges longer than this many times the usual distance lie across a step in depth, unless the
/// surface is seen at less than 15 degrees, where a scanner measures little of use anyway.
constexpr float longest_edge = 4;

/// The median distance of the grid's neighbours that are `step` cells apart, squared.
float usual_squared_distance(std::span<const Index> grid, std::size_t columns, std::size_t step,
                             const std::vector<Vec3>& positions) {
  std::vector<float> distances;
  for (std::size_t i = 0; i + step < grid.size(); ++i) {
    if (step == 1 && (i + 1) % columns == 0) continue;  // the next one is in another row
    if (grid[i] == no_index || grid[i + step] == no_index) continue;
    distances.push_back((positions[grid[i]] - positions[grid[i + step]]).squaredNorm());
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

void triangulate_grid(std::span<const Index> grid, std::size_t columns, Mesh& mesh) {
  const std::vector<Vec3>& positions = mesh.positions;
  const auto squared_distance = [&](Index a, Index b) {
    return (positions[a] - positions[b]).squaredNorm();
  };
  const float limit = longest_edge * longest_edge *
                      std::max(usual_squared_distance(grid, columns, 1, positions),
                               usual_squared_distance(grid, columns, columns, positions));
  std::vector<std::array<Index, 3>> triangles;
  double facing = 0;  // the sum of the normals' z
  const auto add = [&](Index a, Index b, Index c) {
    if (std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)}) > limit)
      return;
    triangles.push_back({a, b, c});
    facing += (positions[b] - positions[a]).cross(positions[c] - positions[a]).z();
  };
  for (std::size_t i = 0; i + columns + 1 < grid.size(); ++i) {
    if ((i + 1) % columns == 0) continue;
    std::array<Index, 4> around = {grid[i], grid[i + columns], grid[i + columns + 1], grid[i + 1]};
    const auto end = std::remove(around.begin(), around.end(), no_index);
    const auto [a, b, c, d] = around;
    if (end == around.begin() + 3) add(a, b, c);
    if (end != around.end()) continue;
    if (squared_distance(a, c) <= squared_distance(b, d)) {
      add(a, b, c);
      add(a, c, d);
    } else {
      add(b, c, d);
      add(b, d, a);
    }
  }
  for (const auto& [a, b, c] : triangles) {
    if (facing >= 0) {
      mesh.faces.push_back({a, b, c});
    } else {
      mesh.faces.push_back({a, c, b});
    }
  }
}

}  // namespace meshgrain::io
