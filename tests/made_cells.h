#pragma once

#include <array>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain::made {

using Cell = std::array<int, 3>;

/// The quads between unit cubes that are there and those that are not: where two cubes have only an
/// edge in common, four of them meet.
inline Mesh surface_of_cells(const std::set<Cell>& cells) {
  Mesh mesh;
  std::map<Cell, Index> vertices;
  const auto vertex = [&](const Cell& at) {
    const auto [it, is_new] = vertices.emplace(at, static_cast<Index>(mesh.positions.size()));
    if (is_new) {
      mesh.positions.emplace_back(static_cast<float>(at[0]), static_cast<float>(at[1]),
                                  static_cast<float>(at[2]));
    }
    return it->second;
  };
  for (const Cell& cell : cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        Cell other = cell, corner = cell;
        other[axis] += step;
        if (cells.contains(other)) continue;
        if (step > 0) ++corner[axis];
        const std::size_t u = (axis + (step > 0 ? 1 : 2)) % 3, v = (axis + (step > 0 ? 2 : 1)) % 3;
        std::array<Index, 4> face;
        for (const auto& [k, du, dv] : {std::tuple(0, 0, 0), {1, 1, 0}, {2, 1, 1}, {3, 0, 1}}) {
          Cell at = corner;
          at[u] += du;
          at[v] += dv;
          face[static_cast<std::size_t>(k)] = vertex(at);
        }
        mesh.faces.push_back(face);
      }
    }
  }
  return mesh;
}

/// A tube with a disc across its middle: along the rim of that three faces meet.
inline Mesh tube_with_membrane() {
  constexpr int sides = 32, rings = 12, steps = 5;
  Mesh mesh;
  const auto add_ring = [&](float radius, float height) {
    for (int k = 0; k < sides; ++k) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / sides;
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  };
  const auto join = [&](int below, int above) {
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides;
      const auto corner = [&](int ring, int side) {
        return static_cast<Index>(ring * sides + side);
      };
      mesh.faces.push_back(
          {corner(below, k), corner(below, next), corner(above, next), corner(above, k)});
    }
  };
  for (int ring = 0; ring <= rings; ++ring) add_ring(1, 0.2f * static_cast<float>(ring));
  for (int ring = 0; ring < rings; ++ring) join(ring, ring + 1);
  const float middle = 0.2f * rings / 2;
  for (int step = 1; step < steps; ++step) add_ring(1 - static_cast<float>(step) / steps, middle);
  join(rings / 2, rings + 1);
  for (int step = 1; step + 1 < steps; ++step) join(rings + step, rings + step + 1);
  const auto center = static_cast<Index>(mesh.positions.size());
  mesh.positions.emplace_back(0.0f, 0.0f, middle);
  for (int k = 0; k < sides; ++k) {
    const auto last = static_cast<Index>((rings + steps - 1) * sides);
    mesh.faces.push_back(
        {last + static_cast<Index>(k), last + static_cast<Index>((k + 1) % sides), center});
  }
  return mesh;
}

}  // namespace meshgrain::made
