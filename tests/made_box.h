#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "meshgrain/triangulate.h"

namespace meshgrain::made {

/// A box whose edges are rounded by so many segments with a radius; by one: chamfered.
inline Mesh rounded_box(const Vec3& half, float radius, Index segments) {
  Mesh mesh;
  const Index across = segments + 1;
  std::vector<std::vector<Index>> rows;  // from the top down, each once around
  for (Index row = 0; row < 2 * across; ++row) {
    const bool is_upper = row < across;
    const Index step = is_upper ? row : 2 * across - 1 - row;
    const bool is_flat = step == 0;  // a corner of the top or the bottom
    std::vector<Index>& around = rows.emplace_back();
    for (Index quarter = 0; quarter < 4; ++quarter) {
      for (Index i = 0; i < across; ++i) {
        if (is_flat && i > 0) {
          around.push_back(around.back());
          continue;
        }
        const auto right = std::numbers::pi / 2;
        const double down = right * step / segments,
                     turn = right * (quarter + double(i) / segments);
        const Vec3 out(static_cast<float>(std::sin(down) * std::cos(turn)),
                       static_cast<float>(std::sin(down) * std::sin(turn)),
                       static_cast<float>(is_upper ? std::cos(down) : -std::cos(down)));
        const Vec3 corner(quarter == 0 || quarter == 3 ? 1.f : -1.f, quarter < 2 ? 1.f : -1.f,
                          is_upper ? 1.f : -1.f);
        around.push_back(static_cast<Index>(mesh.positions.size()));
        mesh.positions.push_back(corner.cwiseProduct(half - Vec3::Constant(radius)) + radius * out);
      }
    }
  }
  const Index count = 4 * across;
  for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
    for (Index i = 0; i < count; ++i) {
      const Index next = (i + 1) % count;
      const Index a = rows[row][i], b = rows[row][next];
      const Index c = rows[row + 1][i], d = rows[row + 1][next];
      if (a == b && c == d) continue;
      if (a == b)
        mesh.faces.push_back({a, c, d});
      else if (c == d)
        mesh.faces.push_back({a, c, b});
      else
        mesh.faces.push_back({a, c, d, b});
    }
  }
  const auto& top = rows.front();
  const auto& bottom = rows.back();
  mesh.faces.push_back({top[0], top[across], top[2 * across], top[3 * across]});
  mesh.faces.push_back({bottom[3 * across], bottom[2 * across], bottom[across], bottom[0]});
  return triangulate(mesh);
}

}  // namespace meshgrain::made
