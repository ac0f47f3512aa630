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

/// What `test(f, out)` appends to `out` for each face.
template <typename Item, typename Test>
std::vector<Item> at_faces(std::size_t faces, const Test& test, const Context& context) {
  return collect<Item>(
      faces,
      [&](std::size_t begin, std::size_t end, std::vector<Item>& out) {
        for (std::size_t f = begin; f < end; ++f) test(static_cast<Index>(f), out);
      },
      context);
}

}  // namespace

std::vector<OrientationSingularity> orientation_singularities(const Mesh& triangles,
                                                              const std::vector<Vec3>& normals,
                                                              const OrientationField& field,
                                                              const Context& context) {
  return at_faces<OrientationSingularity>(
      triangles.faces.size(),
      [&](Index f, std::vector<OrientationSingularity>& out) {
        const auto v = triangles.faces[f];
        double total = holonomy(normals[v[0]], normals[v[1]], normals[v[2]]);
        for (std::size_t k = 0; k < 3; ++k) total += turn(normals, field, v[k], v[(k + 1) % 3]);
        const auto index = static_cast<int>(std::lround(total * field.rosy / (2 * pi)));
        if (index != 0) out.push_back({f, index});
      },
      context);
}

std::vector<PositionSingularity> position_singularities(const Mesh& triangles, const Graph& graph,
                                                        const OrientationField& orientation,
                                                        const PositionField& position,
                                                        PositionEnergy energy,
                                                        const Context& context) {
  return at_faces<PositionSingularity>(
      triangles.faces.size(),
      [&](Index f, std::vector<PositionSingularity>& out) {
        const auto v = triangles.faces[f];
        const int posy = position.posy;
        std::array<int, 2> total{0, 0};
        int rotation = 0;  // that turns the current vertex's frame into the first's
        for (std::size_t k = 0; k < 3; ++k) {
          const Jump jump = edge_jump(graph, orientation, position, energy, v[k], v[(k + 1) % 3]);
          const auto t = rotate_jump(jump.t, (posy - rotation) % posy, posy);
          total = {total[0] + t[0], total[1] + t[1]};
          rotation = (rotation + jump.rotation) % posy;
        }
        if (rotation == 0 && (total[0] != 0 || total[1] != 0)) out.push_back({f, total});
      },
      context);
}

}  // namespace meshgrain
