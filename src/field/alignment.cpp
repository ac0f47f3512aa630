#include "meshgrain/alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/border.h"
#include "meshgrain/curvature.h"

namespace meshgrain {

BorderConstraints border_constraints(const Mesh& mesh) {
  BorderConstraints result;
  struct Sum {
    Vec3 direction = Vec3::Zero();
    bool corner = false;
  };
  std::vector<Sum> sums(mesh.positions.size());
  std::vector<Index> vertices;
  for (const auto& [a, b] : border_edges(mesh)) {
    const Vec3 d = mesh.positions[b] - mesh.positions[a];
    const float length = d.norm();
    if (!(length > 0)) continue;
    for (const Index v : {a, b}) {
      Sum& sum = sums[v];
      if (sum.direction.isZero()) {
        vertices.push_back(v);
        sum.direction = d / length;
      } else {
        // Where the border turns sharply no direction is better than the other.
        constexpr float cos40 = 0.766f;
        sum.corner = sum.corner || sum.direction.normalized().dot(d / length) < cos40;
        sum.direction += d / length;
      }
    }
  }
  std::sort(vertices.begin(), vertices.end());
  for (const Index v : vertices) {
    const Vec3& p = mesh.positions[v];
    if (sums[v].corner) {
      result.position.push_back({v, p, Vec3::Zero(), 1});
    } else {
      const Vec3 direction = sums[v].direction.normalized();
      result.orientation.push_back({v, direction, 1});
      result.position.push_back({v, p, direction, 1});
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
