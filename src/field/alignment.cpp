#include "meshgrain/alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshgrain/curvature.h"

namespace meshgrain {

FeatureConstraints feature_constraints(const FeatureLines& lines) {
  FeatureConstraints result;
  std::vector<std::uint8_t> followed(lines.corners.size(), 0);
  const auto corner = [&](Index v) {
    const auto it = std::lower_bound(lines.corners.begin(), lines.corners.end(), v);
    return it != lines.corners.end() && *it == v ? it - lines.corners.begin() : -1;
  };
  for (std::size_t line = 0; line < lines.size(); ++line) {
    if (lines.align[line] == 0) continue;
    const Index begin = lines.begin(line), last = lines.end(line) - 1;
    const bool closed = lines.is_closed(line);
    for (Index k = begin; k < last + !closed; ++k) {
      const Vec3& p = lines.positions[k];
      if (const auto c = corner(lines.vertices[k]); c >= 0) {
        if (!followed[c]++) result.position.push_back({lines.vertices[k], p, Vec3::Zero(), 1});
        continue;
      }
      const Vec3& before = lines.positions[k > begin ? k - 1 : last - 1];
      const Vec3 in = p - before, out = lines.positions[k + 1] - p;
      Vec3 direction = in.normalized() + out.normalized();
      if (!(direction.norm() > 1e-3f)) continue;  // it turns back
      direction.normalize();
      if (lines.orient[line] > 0) {
        result.orientation.push_back({lines.vertices[k], direction, lines.orient[line]});
      }
      result.position.push_back({lines.vertices[k], p, direction, lines.align[line]});
    }
  }
  return result;
}

std::vector<OrientationConstraint> curvature_constraints(const Graph& graph, float edge_length,
                                                         const CurvatureAlignment& alignment,
                                                         const Context& context) {
  std::vector<OrientationConstraint> result;
  if (alignment.strength <= 0 && alignment.hard_degrees <= 0) return result;
  const Curvature curvature = estimate_curvature(graph.offsets, graph.neighbors, graph.positions,
                                                 graph.normals, context, 1);
  for (Index i = 0; i < graph.size(); ++i) {
    // How much more the normal turns along one principal direction than along the other.
    const float bend =
        std::fabs(std::fabs(curvature.kmax[i]) - std::fabs(curvature.kmin[i])) * edge_length;
    const float degrees = bend * 180 / std::numbers::pi_v<float>;
    if (alignment.hard_degrees > 0 && degrees >= alignment.hard_degrees) {
      result.push_back({i, curvature.direction[i], 1});
    } else if (alignment.strength > 0) {
      // Directions mean nothing where the surface is flat or round.
      const float strength = std::min(alignment.strength, 1.0f) * bend / (bend + 0.1f);
      if (strength > 1e-3f) result.push_back({i, curvature.direction[i], strength});
    }
  }
  return result;
}

}  // namespace meshgrain
