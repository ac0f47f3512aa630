#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "meshgrain/extract.h"
#include "meshgrain/features.h"

namespace meshgrain::made {

/// Over a plate: a square grid of `cells` by `cells` quads, with vertices at some of the plate's.
inline Extraction grid_over(const Mesh& plate, Index cells) {
  std::map<std::array<int, 2>, Index> node;  // by its place in the grid
  const auto n = static_cast<float>(cells);
  for (Index v = 0; v < plate.positions.size(); ++v) {
    const Vec3 p = n * (plate.positions[v] + Vec3(0.5f, 0.5f, 0));
    const std::array<int, 2> place{static_cast<int>(std::lround(p.x())),
                                   static_cast<int>(std::lround(p.y()))};
    if ((p - Vec3(static_cast<float>(place[0]), static_cast<float>(place[1]), 0)).norm() < 1e-3f) {
      node[place] = v;
    }
  }
  Extraction grid;
  const auto vertex = [&](Index x, Index y) { return y * (cells + 1) + x; };
  for (Index y = 0; y <= cells; ++y) {
    for (Index x = 0; x <= cells; ++x) {
      grid.nodes.push_back(node.at({static_cast<int>(x), static_cast<int>(y)}));
      grid.mesh.positions.push_back(plate.positions[grid.nodes.back()]);
      grid.mesh.normals.push_back(Vec3::UnitZ());
      if (x % cells == 0 && y % cells == 0) grid.corners.push_back(vertex(x, y));
    }
  }
  for (Index y = 0; y < cells; ++y) {
    for (Index x = 0; x < cells; ++x) {
      grid.mesh.faces.push_back(
          std::array{vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
    }
  }
  const FeatureLines border =
      find_features(plate, {.creases = Creases::none, .align_border = false}, 0, Context());
  const auto add_border = [&](Index a, Index b) {
    for (Index line = 0; line < border.size(); ++line) {
      const std::set<Index> on(border.vertices.begin() + border.begin(line),
                               border.vertices.begin() + border.end(line));
      if (!on.contains(grid.nodes[a]) || !on.contains(grid.nodes[b])) continue;
      grid.line_edges.push_back({a, b, line});
      return;
    }
    FAIL() << "no line of the border has both";
  };
  for (Index k = 0; k < cells; ++k) {
    add_border(vertex(k, 0), vertex(k + 1, 0));
    add_border(vertex(k, cells), vertex(k + 1, cells));
    add_border(vertex(0, k), vertex(0, k + 1));
    add_border(vertex(cells, k), vertex(cells, k + 1));
  }
  return grid;
}

}  // namespace meshgrain::made
