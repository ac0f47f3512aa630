#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "meshgrain/error.h"
#include "shapes/makers.h"
#include "shapes/patches.h"

namespace meshgrain::shapes {
namespace {

using Point = Eigen::Vector3d;

/// A smooth stand-in for max(a, b): off by log(2) / sharpness where both are equal.
double smooth_max(double a, double b, double sharpness) {
  const double most = std::max(a, b), least = std::min(a, b);
  return most + std::log1p(std::exp(sharpness * (least - most))) / sharpness;
}

/// Three lobes about the z axis, a hole through each: negative inside.
double three_holes_field(const Point& p) {
  constexpr double lobe_centre = 0.64, lobe_radius = 0.62, hole_radius = 0.27;
  constexpr double rounding = 0.22, half_height = 0.24;
  std::array<double, 3> distance;
  for (int k = 0; k < 3; ++k) {
    const double angle = std::numbers::pi * (0.5 + 2.0 / 3 * k);
    distance[k] =
        std::hypot(p.x() - lobe_centre * std::cos(angle), p.y() - lobe_centre * std::sin(angle));
  }
  // Seen along z: inside a lobe, outside the holes.
  double inside = lobe_radius - distance[0];
  for (int k = 1; k < 3; ++k) inside = smooth_max(inside, lobe_radius - distance[k], 7);
  double flat = -inside;
  for (int k = 0; k < 3; ++k) flat = smooth_max(flat, hole_radius - distance[k], 16);
  // Rounded off towards the outline as an ellipse, flat further in.
  const double rim = 1 + flat / rounding;
  const double rise = (rim + std::sqrt(rim * rim + 0.01)) / 2;
  return std::hypot(rise, p.z() / half_height) - 1;
}

template <class Field>
Point gradient(Field&& field, const Point& p) {
  constexpr double h = 1e-5;
  Point g;
  for (int k = 0; k < 3; ++k) {
    const Point d = h * Point::Unit(k);
    g[k] = (field(p + d) - field(p - d)) / (2 * h);
  }
  return g;
}

/// Moves a point near the zero set onto it, by Newton's method along the gradient.
template <class Field>
Point project(Field&& field, Point p) {
  for (int round = 0; round < 3; ++round) {
    const double distance = field(p);
    if (std::abs(distance) < 1e-7) break;
    const Point g = gradient(field, p);
    p -= distance / std::max(g.squaredNorm(), 1e-12) * g;
  }
  return p;
}

/// Whether on some side of a cell the corners inside are opposite to each other, so that the
/// surface could go either way there. Corners are bits: x, y, z.
template <class Inside>
bool has_checkered_side(Inside&& inside) {
  for (int across = 1; across < 8; across <<= 1) {
    const int u = across == 1 ? 2 : 1, v = across == 4 ? 2 : 4;
    for (const int c : {0, across}) {
      const bool a = inside(c), b = inside(c | u), d = inside(c | u | v), e = inside(c | v);
      if (a == d && b == e && a != b) return true;
    }
  }
  return false;
}

/// The zero set within a box as quads: one vertex in each grid cell with a change of sign, one quad
/// around each grid edge with one (Gibson's surface nets, 1998). Nothing if the grid is too coarse
/// for the field to tell what is connected, or a level part of the surface lies just along a layer.
/// Walks the grid layer by layer and keeps only two of them.
template <class Field>
std::optional<Mesh> surface_net(Field&& field, const Point& low, const Point& high, double step) {
  const Eigen::Vector3i n = ((high - low) / step).array().ceil().cast<int>();
  const int row = n.x() + 1;
  const auto node = [&](int i, int j, int k) { return Point(low + step * Point(i, j, k)); };
  std::array<std::vector<double>, 2> value;  // at the nodes of this layer and the next
  std::array<std::vector<Index>, 2> cell;    // the vertex in each cell of the last layer and this
  for (auto& layer : value) layer.resize(std::size_t(row) * (n.y() + 1));
  for (auto& layer : cell) layer.assign(std::size_t(row) * (n.y() + 1), no_index);
  const auto sample = [&](int k, std::vector<double>& layer) {
    for (int j = 0; j <= n.y(); ++j)
      for (int i = 0; i <= n.x(); ++i) layer[j * row + i] = field(node(i, j, k));
  };

  Mesh net;
  const auto add = [&](bool flip, Index a, Index b, Index c, Index d) {
    flip ? net.faces.push_back({d, c, b, a}) : net.faces.push_back({a, b, c, d});
  };
  sample(0, value[1]);
  for (int k = 0; k < n.z(); ++k) {
    std::swap(value[0], value[1]);
    std::swap(cell[0], cell[1]);
    sample(k + 1, value[1]);
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i) {
        // The cell's vertex: the mean of where the field vanishes on its edges, then projected.
        const auto corner = [&](int c) {
          return value[c >> 2][(j + (c >> 1 & 1)) * row + i + (c & 1)];
        };
        if (has_checkered_side([&](int c) { return corner(c) < 0; })) return std::nullopt;
        Point sum = Point::Zero();
        int crossings = 0;
        for (int c = 0; c < 8; ++c)
          for (int bit = 1; bit < 8; bit <<= 1) {
            if (c & bit || (corner(c) < 0) == (corner(c | bit) < 0)) continue;
            const double t = corner(c) / (corner(c) - corner(c | bit));
            const auto offset = [](int x) { return Point(x & 1, x >> 1 & 1, x >> 2); };
            sum += (1 - t) * offset(c) + t * offset(c | bit);
            ++crossings;
          }
        Index& v = cell[1][j * row + i];
        v = no_index;
        if (crossings == 0) continue;
        v = static_cast<Index>(net.positions.size());
        net.positions.push_back(
            project(field, node(i, j, k) + step / crossings * sum).template cast<float>());
      }
    // The box reaches beyond the surface: no grid edge on its sides has a change of sign.
    for (int j = 1; j < n.y(); ++j)
      for (int i = 1; i < n.x(); ++i) {
        const int at = j * row + i;
        const bool in = value[0][at] < 0;
        const auto &below = cell[0], &here = cell[1];
        if (in != (value[1][at] < 0))
          add(!in, here[at - row - 1], here[at - row], here[at], here[at - 1]);
        if (in != (value[0][at + 1] < 0))
          add(!in, below[at - row], below[at], here[at], here[at - row]);
        if (in != (value[0][at + row] < 0))
          add(!in, below[at - 1], here[at - 1], here[at], below[at]);
      }
  }
  return net;
}

/// Evens a mesh out: each vertex to the middle of its neighbours, and back onto the surface.
template <class Field>
void relax(Mesh& mesh, Field&& field, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> sum(mesh.positions.size(), Vec3::Zero());
    std::vector<float> count(mesh.positions.size(), 0);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = mesh.faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) {
        sum[face[c]] += mesh.positions[face[(c + 1) % face.size()]];
        count[face[c]] += 1;
      }
    }
    for (std::size_t v = 0; v < sum.size(); ++v)
      mesh.positions[v] = project(field, (sum[v] / count[v]).cast<double>()).template cast<float>();
  }
}

}  // namespace

Mesh three_holes(double resolution) {
  const double step = 0.035 / resolution;
  Point low(-1.4, -1.4, -0.4);
  std::optional<Mesh> found;
  for (int attempt = 0; !found; ++attempt) {
    constexpr int attempts = 8;
    if (attempt == attempts) throw Error("three-holes cannot be sampled as coarsely as this");
    found = surface_net(three_holes_field, low, Point(1.4, 1.4, 0.4), step);
    low.z() -= step / attempts;
  }
  Mesh& net = *found;
  relax(net, three_holes_field, 6);
  Mesh mesh;
  mesh.positions = std::move(net.positions);
  for (std::size_t f = 0; f < net.faces.size(); ++f) {
    const auto quad = net.faces[f];
    add_quad(mesh, quad[0], quad[1], quad[2], quad[3]);
  }
  return mesh;
}

}  // namespace meshgrain::shapes
