#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "meshgrain/guides.h"
#include "meshgrain/mesh.h"

namespace meshgrain::made {

using Point = Eigen::Vector3d;

/// Points of a curve of one parameter from 0 to 1.
template <typename Curve>
Guide guide_along(const Curve& curve, int count = 200) {
  Guide guide;
  for (int k = 0; k <= count; ++k) guide.points.push_back(curve(static_cast<double>(k) / count));
  return guide;
}

/// The part of a great circle of the unit sphere (or of any shape around the middle, if the guide
/// need not lie on it) from angle `from` to `to`, in the plane across `axis`.
inline Guide arc(const Point& axis, double from, double to) {
  const Point u = axis.unitOrthogonal(), v = axis.normalized().cross(u);
  return guide_along([&](double t) -> Point {
    const double a = from + t * (to - from);
    return std::cos(a) * u + std::sin(a) * v;
  });
}

/// The longest of the curves in which a plane (normal · p = offset) cuts a closed triangle mesh.
inline Guide section(const Mesh& mesh, const Point& normal, double offset) {
  std::vector<double> side;
  for (const Vec3& p : mesh.positions) {
    const double d = normal.dot(p.cast<double>()) - offset;
    side.push_back(d == 0 ? 1e-9 : d);
  }
  using Edge = std::pair<Index, Index>;
  std::map<Edge, Edge> next;  // crossed edges, from one to the next
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    Edge in, out;
    bool cut = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = face[k], b = face[(k + 1) % 3];
      if ((side[a] > 0) == (side[b] > 0)) continue;
      cut = true;
      (side[a] > 0 ? in : out) = std::minmax(a, b);
    }
    if (cut) next[in] = out;
  }
  Guide longest;
  double most = 0;
  while (!next.empty()) {
    Guide guide;
    guide.closed = true;
    for (auto it = next.begin(); it != next.end();) {
      const auto [a, b] = it->first;
      const double share = side[a] / (side[a] - side[b]);
      guide.points.push_back((1 - share) * mesh.positions[a].cast<double>() +
                             share * mesh.positions[b].cast<double>());
      const Edge to = it->second;
      next.erase(it);
      it = next.find(to);
    }
    double length = 0;
    for (std::size_t k = 1; k < guide.points.size(); ++k) {
      length += (guide.points[k] - guide.points[k - 1]).norm();
    }
    if (length <= most) continue;
    most = length;
    longest = guide;
  }
  return longest;
}

/// A share of a guide, from its beginning; no longer closed.
inline Guide part(const Guide& guide, double from, double to) {
  const auto n = static_cast<double>(guide.points.size());
  Guide result;
  result.points.assign(guide.points.begin() + static_cast<std::ptrdiff_t>(from * n),
                       guide.points.begin() + static_cast<std::ptrdiff_t>(to * n));
  return result;
}

/// The share of the length of guides along which an edge of a mesh lies: the nearest one within a
/// quarter of an edge's length, and turned by no more than ten degrees. Measured by brute force.
inline double followed(const std::vector<Guide>& guides, const Mesh& mesh) {
  std::vector<std::array<Point, 2>> edges;
  double mean = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k], b = face[(k + 1) % face.size()];
      edges.push_back({mesh.positions[a].cast<double>(), mesh.positions[b].cast<double>()});
      mean += (edges.back()[0] - edges.back()[1]).norm();
    }
  }
  mean /= static_cast<double>(edges.size());
  double good = 0, total = 0;
  for (const Guide& guide : guides) {
    const std::size_t n = guide.points.size(), segments = guide.closed ? n : n - 1;
    for (std::size_t s = 0; s < segments; ++s) {
      const Point &a = guide.points[s], &b = guide.points[(s + 1) % n];
      const double length = (b - a).norm();
      const int samples = static_cast<int>(length / (0.1 * mean)) + 1;
      for (int k = 0; k < samples; ++k) {
        const Point p = a + (k + 0.5) / samples * (b - a);
        double least = 1e30, cosine = 0;
        for (const auto& [c, d] : edges) {
          const Point along = d - c;
          const double share = std::clamp((p - c).dot(along) / along.squaredNorm(), 0.0, 1.0);
          const double distance = (c + share * along - p).squaredNorm();
          if (distance >= least) continue;
          least = distance;
          cosine = std::abs(along.normalized().dot((b - a).normalized()));
        }
        const bool is_good =
            least < 0.0625 * mean * mean && cosine > std::cos(10 * std::numbers::pi / 180);
        good += is_good ? length / samples : 0;
        total += length / samples;
      }
    }
  }
  return good / total;
}

}  // namespace meshgrain::made
