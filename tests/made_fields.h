#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "meshgrain/fields.h"

namespace meshgrain::made {

/// Two coordinates and their (unit) directions at a point of a surface. The lattice has a point
/// wherever both coordinates are integers times the edge length.
struct Coordinates {
  double a, b;
  Vec3 along_a;
};

struct SampledFields {
  OrientationField orientation;
  PositionField position;
};

/// The fields of a parametrization: at each node, the lattice point nearest to it as the plane
/// through the node would have it. Coordinates are measured along the axes of the lattice, which
/// for a 6-PoSy stand at 60 degrees: `a` along the first and `b` along the second.
inline SampledFields sample_fields(const Graph& graph, int symmetry, float edge_length,
                                   const std::function<Coordinates(const Vec3&)>& parametrization) {
  SampledFields fields{{symmetry, {}}, {symmetry, EdgeLength(edge_length), {}}};
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const Coordinates c = parametrization(graph.positions[i]);
    const Vec3& n = graph.normals[i];
    const Vec3 u = (c.along_a - n * n.dot(c.along_a)).normalized();
    Vec3 v = n.cross(u);
    if (symmetry == 6) v = 0.5f * u + 0.866025404f * v;
    const double x = c.a / edge_length, y = c.b / edge_length;
    Vec3 best = Vec3::Zero();
    float least = 1e9f;
    for (const double i0 : {std::floor(x), std::floor(x) + 1}) {
      for (const double j0 : {std::floor(y), std::floor(y) + 1}) {
        const Vec3 offset =
            edge_length * (static_cast<float>(i0 - x) * u + static_cast<float>(j0 - y) * v);
        if (offset.norm() < least) {
          least = offset.norm();
          best = offset;
        }
      }
    }
    fields.orientation.directions.push_back(u);
    fields.position.points.push_back(graph.positions[i] + best);
  }
  return fields;
}

/// A triangulated grid, `wrap`ped around or open in either direction, of places by (u, v) in [0,
/// 1].
inline Mesh grid(std::size_t columns, std::size_t rows, bool wrap_u, bool wrap_v,
                 const std::function<Vec3(double, double)>& place) {
  Mesh mesh;
  const std::size_t w = columns + !wrap_u, h = rows + !wrap_v;
  for (std::size_t j = 0; j < h; ++j) {
    for (std::size_t i = 0; i < w; ++i) {
      mesh.positions.push_back(place(static_cast<double>(i) / static_cast<double>(columns),
                                     static_cast<double>(j) / static_cast<double>(rows)));
    }
  }
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      const auto at = [&](std::size_t x, std::size_t y) {
        return static_cast<Index>(y % h * w + x % w);
      };
      const Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
      } else {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
      }
    }
  }
  return mesh;
}

}  // namespace meshgrain::made
