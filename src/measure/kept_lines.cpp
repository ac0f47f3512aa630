#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "measure/bvh.h"
#include "mesh/border.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

using Edges = std::vector<std::array<Index, 2>>;

/// What counts as following a line: how near, in edges of the output, and how much along it.
struct Nearness {
  double distance, cosine;
};
constexpr Nearness for_creases{0.1, 0.94};  // 20 degrees
constexpr Nearness for_borders{0.2, 0};     // those of scans are ragged

/// The share of the length of `lines` that edges of `others` follow.
double followed(const Mesh& input, const Edges& lines, const Mesh& output, const Edges& others,
                double edge, const Nearness& nearness) {
  if (others.empty()) return 0;
  Mesh segments;  // triangles without area
  segments.positions = output.positions;
  for (const auto& [a, b] : others) segments.faces.push_back({a, b, b});
  const Bvh tree(segments);
  const Eigen::Vector3d shift = input.origin - output.origin;
  double length = 0, kept = 0;
  for (const auto& [a, b] : lines) {
    const Eigen::Vector3d p = input.positions[a].cast<double>() + shift;
    const Eigen::Vector3d along = (input.positions[b] - input.positions[a]).cast<double>();
    const auto samples = static_cast<int>(std::ceil(along.norm() / (edge / 4)));
    const double near = nearness.distance * edge;
    for (int k = 0; k < samples; ++k) {
      const double step = along.norm() / samples;
      length += step;
      const auto hit = tree.closest(p + (k + 0.5) / samples * along, near * near);
      if (hit.triangle == no_index) continue;
      const auto [c, d] = others[hit.triangle];
      const Eigen::Vector3d other = (output.positions[d] - output.positions[c]).cast<double>();
      const double lengths = along.norm() * other.norm();
      if (std::abs(along.dot(other)) >= nearness.cosine * lengths) kept += step;
    }
  }
  return length > 0 ? kept / length : 1;
}

/// Where creases meet, or turn by more than 40 degrees.
std::vector<Index> corners_of(const Mesh& mesh, const Edges& creases) {
  std::map<Index, std::vector<Vec3>> spokes;
  for (const auto& [a, b] : creases) {
    const Vec3 along = (mesh.positions[b] - mesh.positions[a]).normalized();
    spokes[a].push_back(along);
    spokes[b].push_back(-along);
  }
  std::vector<Index> result;
  for (const auto& [v, directions] : spokes) {
    constexpr float cos40 = 0.766f;
    const bool straight = directions.size() == 2 && directions[0].dot(directions[1]) < -cos40;
    if (directions.size() > 1 && !straight) result.push_back(v);
  }
  return result;
}

}  // namespace

KeptLines kept_lines(const Mesh& input, const Mesh& output, double crease_degrees) {
  KeptLines result;
  const double edge = edge_lengths(output).mean;
  const Edges creases = crease_edges(input, crease_degrees);
  if (!creases.empty()) {
    result.creases = followed(input, creases, output, crease_edges(output, crease_degrees / 2),
                              edge, for_creases);
  }
  const Edges border = border_edges(input);
  if (!border.empty())
    result.border = followed(input, border, output, border_edges(output), edge, for_borders);
  Mesh points;
  points.positions = output.positions;
  const Bvh tree(points);
  for (const Index v : corners_of(input, creases)) {
    const Eigen::Vector3d p = input.positions[v].cast<double>() + input.origin - output.origin;
    ++result.corners;
    const double near = for_creases.distance * edge;
    result.corners_kept += tree.closest(p, near * near).triangle != no_index;
  }
  return result;
}

}  // namespace meshgrain
