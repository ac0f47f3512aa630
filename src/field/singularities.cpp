#include "meshgrain/singularities.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/jumps.h"
#include "field/rosy.h"
#include "util/collect.h"

namespace meshgrain {
namespace {

constexpr double pi = std::numbers::pi;

/// The angle about `n` from one tangent vector to another.
double angle_between(const Vec3& from, const Vec3& to, const Vec3& n) {
  return std::atan2(static_cast<double>(n.dot(from.cross(to))), static_cast<double>(from.dot(to)));
}

/// How far a vector turns when it is transported around a triangle: the solid angle of the normals.
double holonomy(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double triple = a.dot(b.cross(c));
  const double sum = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
  return 2 * std::atan2(triple, sum);
}

/// From the field at i to that at j by the nearest representative: between -pi / N and pi / N.
double turn(const std::vector<Vec3>& normals, const OrientationField& field, Index i, Index j) {
  const double step = 2 * pi / field.rosy;
  // Measured from the lower index, so that the two directions of an edge cancel exactly.
  const Index low = std::min(i, j), high = std::max(i, j);
  const Vec3 moved = transport(field.directions[high], normals[high], normals[low]);
  const double raw = angle_between(field.directions[low], moved, normals[low]);
  const double nearest = raw - step * std::round(raw / step);
  return i == low ? nearest : -nearest;
}

}  // namespace

std::vector<OrientationSingularity> orientation_singularities(const Mesh& triangles,
                                                              const std::vector<Vec3>& normals,
                                                              const OrientationField& field,
                                                              const Context& context) {
  using Singularity = OrientationSingularity;
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Singularity>& out) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto v = triangles.faces[f];
      double total = holonomy(normals[v[0]], normals[v[1]], normals[v[2]]);
      for (std::size_t k = 0; k < 3; ++k) total += turn(normals, field, v[k], v[(k + 1) % 3]);
      const auto index = static_cast<int>(std::lround(total * field.rosy / (2 * pi)));
      if (index != 0) out.push_back({static_cast<Index>(f), index});
    }
  };
  return collect<Singularity>(triangles.faces.size(), look, context);
}

std::vector<PositionSingularity> position_singularities(const Mesh& triangles, const Graph& graph,
                                                        const OrientationField& orientation,
                                                        const PositionField& position,
                                                        PositionEnergy energy,
                                                        const Context& context) {
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<PositionSingularity>& out) {
    std::vector<std::array<Index, 2>> sides;
    for (std::size_t f = begin; f < end; ++f) {
      const auto v = triangles.faces[f];
      for (std::size_t k = 0; k < 3; ++k) sides.push_back({v[k], v[(k + 1) % 3]});
    }
    const std::vector<Jump> jumps = edge_jumps(graph, orientation, position, energy, sides);
    for (std::size_t f = begin; f < end; ++f) {
      const Jump* around = &jumps[3 * (f - begin)];
      const Jump sum =
          composed(composed(around[0], around[1], position.posy), around[2], position.posy);
      if (sum.rotation == 0 && !sum.is_zero()) out.push_back({static_cast<Index>(f), sum.t});
    }
  };
  return collect<PositionSingularity>(triangles.faces.size(), look, context);
}

}  // namespace meshgrain
