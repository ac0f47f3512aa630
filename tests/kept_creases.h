#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <vector>

#include "mesh/border.h"
#include "meshgrain/surface.h"
#include "util/triangle.h"

namespace meshgrain::made {

struct Kept {
  double creases = 0;  // share of the length of the input's creases that lies on sharp edges
  double corners = 0;
};

/// Measured without any of the code that is tested: points along the input's sharp edges, and how
/// many have an edge of the output within a tenth of an edge, itself sharp and along the crease.
inline Kept kept_creases(const Mesh& input, const Mesh& output) {
  const auto creases = crease_edges(input, 40), sharp = crease_edges(output, 20);
  const double tenth = 0.1 * edge_lengths(output).mean;
  std::map<Index, std::vector<Vec3>> spokes;
  double kept = 0, length = 0;
  for (const auto& [a, b] : creases) {
    const Vec3 &p = input.positions[a], &q = input.positions[b];
    const Vec3 along = (q - p).normalized(), middle = 0.5f * (p + q);
    spokes[a].push_back(along);
    spokes[b].push_back(-along);
    bool found = false;
    for (const auto& [c, d] : sharp) {
      const Vec3 &r = output.positions[c], &s = output.positions[d];
      found = found || ((closest_point_on_segment<Vec3>(middle, r, s) - middle).norm() < tenth &&
                        std::abs(along.dot((s - r).normalized())) > 0.94f);
    }
    length += (q - p).norm();
    kept += found ? (q - p).norm() : 0;
  }
  std::size_t corners = 0, near = 0;
  for (const auto& [v, directions] : spokes) {
    const bool straight = directions.size() == 2 && directions[0].dot(directions[1]) < -0.766f;
    if (straight) continue;
    ++corners;
    double nearest = 1e30;
    for (const Vec3& p : output.positions) {
      nearest = std::min<double>(nearest, (p - input.positions[v]).norm());
    }
    near += nearest < tenth;
  }
  return {kept / length,
          corners > 0 ? static_cast<double>(near) / static_cast<double>(corners) : 1};
}

}  // namespace meshgrain::made
