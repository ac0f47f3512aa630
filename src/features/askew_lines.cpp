#include "features/askew_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meshgrain/alignment.h"

namespace meshgrain {

double share_askew(const FeatureLines& lines, const std::vector<Vec3>& normals,
                   const OrientationField& field) {
  constexpr float far = 0.2588f;  // sine of 15 degrees
  double all = 0, askew = 0;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    if (lines.orient[line] > 0) continue;
    for (Index k = lines.begin(line); k + 1 < lines.end(line); ++k) {
      const Index v = lines.vertices[k];
      const Vec3 step = lines.positions[k + 1] - lines.positions[k];
      const Vec3 &x = field.directions[v], y = normals[v].cross(x);
      const float along = std::abs(step.dot(x)), across = std::abs(step.dot(y));
      all += step.norm();
      if (std::min(along, across) > far * std::hypot(along, across)) askew += step.norm();
    }
  }
  return all > 0 ? askew / all : 0;
}

std::vector<OrientationConstraint> hold_to_lines(FeatureLines lines) {
  for (float& strength : lines.orient) strength = strength > 0 ? 0 : 1;
  return feature_constraints(lines).orientation;
}

}  // namespace meshgrain
