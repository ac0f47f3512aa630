#include "finish/crossings.h"

#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

namespace meshgrain {
namespace {

using Corners = std::array<Index, 3>;
using Points = std::array<Eigen::Vector3d, 3>;

struct Triangle {
  Corners corners;
  Points points;
  Eigen::Vector3d normal;  // twice as long as the area
};

/// The triangles of a face: of a quad, those on either side of both diagonals.
std::vector<Triangle> triangles_of(const Mesh& mesh, Index f) {
  const std::span<const Index> face = mesh.faces[f];
  std::vector<Triangle> triangles;
  triangles.reserve(face.size());
  const auto add = [&](const Corners& corners) {
    Triangle& t = triangles.emplace_back();
    t.corners = corners;
    for (int k = 0; k < 3; ++k) t.points[k] = mesh.positions[corners[k]].cast<double>();
    t.normal = (t.points[1] - t.points[0]).cross(t.points[2] - t.points[0]);
  };
  for (std::size_t k = 2; k < face.size(); ++k) add({face[0], face[k - 1], face[k]});
  if (face.size() == 4) {
    add({face[1], face[2], face[3]});
    add({face[1], face[3], face[0]});
  }
  return triangles;
}

// Faces are taken a little larger than they are, so that what only touches counts too.
constexpr double margin = 1e-3;

/// Of the corners of a triangle over the plane of another, times the length of its normal.
using Heights = std::array<double, 3>;
Heights heights(const Triangle& triangle, const Triangle& plane) {
  Heights result;
  for (int k = 0; k < 3; ++k) result[k] = plane.normal.dot(triangle.points[k] - plane.points[0]);
  return result;
}

/// Whether a triangle lies on one side.
bool beside(const Heights& heights) {
  const auto [low, high] = std::minmax({heights[0], heights[1], heights[2]});
  const double more = margin * (high - low);
  return low - more > 0 || high + more < 0;
}

/// How far the nearer end of an edge of one triangle lies beyond another that it passes through,
/// else 0. `over` are the heights of the former over the latter.
double depth(const Triangle& of, int edge, const Heights& over, const Triangle& triangle) {
  const double from = over[edge], to = over[(edge + 1) % 3];
  const double closest = 2 * margin * std::abs(to - from);  // most edges are far from that
  if (std::min(from, to) > closest || std::max(from, to) < -closest) return 0;
  const Eigen::Vector3d &p = of.points[edge], &q = of.points[(edge + 1) % 3];
  const Eigen::Vector3d& normal = triangle.normal;
  const Eigen::Vector3d more = margin * (q - p);
  const Eigen::Vector3d s = p - more - triangle.points[0], t = q + more - triangle.points[0];
  const double ds = normal.dot(s), dt = normal.dot(t);
  if (!(ds * dt < 0)) return 0;
  const Eigen::Vector3d u = triangle.points[1] - triangle.points[0];
  const Eigen::Vector3d v = triangle.points[2] - triangle.points[0];
  const Eigen::Vector3d x = s + ds / (ds - dt) * (t - s);
  const double outside = -margin * normal.squaredNorm();
  if (normal.dot(u.cross(x)) < outside || normal.dot((v - u).cross(x - u)) < outside ||
      normal.dot(x.cross(v)) < outside) {
    return 0;
  }
  return std::min(std::abs(ds), std::abs(dt)) / normal.norm();
}

double penetration(const Triangle& a, const Triangle& b) {
  int shared = 0, own = 0, other = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (a.corners[i] != b.corners[j]) continue;
      ++shared;
      own = i;
      other = j;
    }
  }
  if (shared > 1) return 0;
  const Heights b_over_a = heights(b, a), a_over_b = heights(a, b);
  // At a shared corner only the edges opposite of it can pass through.
  if (shared == 1) {
    return depth(a, (own + 1) % 3, a_over_b, b) + depth(b, (other + 1) % 3, b_over_a, a);
  }
  if (beside(b_over_a) || beside(a_over_b)) return 0;
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += depth(a, k, a_over_b, b) + depth(b, k, b_over_a, a);
  return sum;
}

/// Whether a plane parts two faces, but for the corners that they share: so most neighbours lie,
/// and this is a small part of the work of comparing their triangles.
bool are_parted(const Mesh& mesh, std::span<const Index> f, std::span<const Index> g) {
  const auto is_in = [](std::span<const Index> face, Index v) {
    return std::ranges::find(face, v) != face.end();
  };
  std::array<Index, 2> shared{no_index, no_index};
  std::size_t count = 0;
  Vec3 across = Vec3::Zero();  // the direction from one to the other
  for (const Index v : f) {
    across -= mesh.positions[v] / static_cast<float>(f.size());
    if (!is_in(g, v)) continue;
    if (count == shared.size()) return false;
    shared[count++] = v;
  }
  for (const Index v : g) across += mesh.positions[v] / static_cast<float>(g.size());
  const Vec3& origin = mesh.positions[count > 0 ? shared[0] : f[0]];
  if (count == 2) {
    const Vec3 edge = mesh.positions[shared[1]] - origin;
    across -= edge * (edge.dot(across) / std::max(edge.squaredNorm(), 1e-30f));
  }
  const auto range = [&](std::span<const Index> face, std::span<const Index> other) {
    std::array<float, 2> result{std::numeric_limits<float>::infinity(),
                                -std::numeric_limits<float>::infinity()};
    for (const Index v : face) {
      if (is_in(other, v)) continue;
      const float height = across.dot(mesh.positions[v] - origin);
      result = {std::min(result[0], height), std::max(result[1], height)};
    }
    return result;
  };
  const auto [f_low, f_high] = range(f, g);
  const auto [g_low, g_high] = range(g, f);
  const float clear = 10 * static_cast<float>(margin) * (g_high - f_low);
  return count == 0 ? g_low - f_high > clear : f_high < -clear && g_low > clear;
}

}  // namespace

Eigen::AlignedBox3f face_box(const Mesh& mesh, Index f) {
  Eigen::AlignedBox3f box;
  for (const Index v : mesh.faces[f]) box.extend(mesh.positions[v]);
  return box;
}

double penetration(const Mesh& mesh, Index f, Index g) {
  if (f == g || !face_box(mesh, f).intersects(face_box(mesh, g))) return 0;
  if (are_parted(mesh, mesh.faces[f], mesh.faces[g])) return 0;
  const std::vector<Triangle> own = triangles_of(mesh, f), other = triangles_of(mesh, g);
  double sum = 0;
  for (const Triangle& t : own) {
    for (const Triangle& u : other) sum += penetration(t, u);
  }
  return sum;
}

std::vector<std::array<Index, 2>> find_crossings(const Mesh& mesh, const Context& context) {
  // The faces by the cells of a grid that their boxes touch. Two meet in the cell of the highest
  // of their low corners, and are compared there only.
  const auto count = static_cast<Index>(mesh.faces.size());
  std::vector<Eigen::AlignedBox3f> boxes(count);
  double size = 0;
  Vec3 lowest = Vec3::Constant(std::numeric_limits<float>::infinity());
  for (Index f = 0; f < count; ++f) {
    boxes[f] = face_box(mesh, f);
    lowest = lowest.cwiseMin(boxes[f].min());
    size += boxes[f].sizes().maxCoeff() / static_cast<double>(count);
  }
  if (!(size > 0)) return {};
  const auto cell = [&](const Vec3& p, int axis) {
    return static_cast<std::uint64_t>((p[axis] - lowest[axis]) / (1.5 * size));
  };
  const auto key = [](std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return (x << 42) | (y << 21) | z;
  };
  struct Entry {
    std::uint64_t cell;
    Index face;
    bool operator<(const Entry& o) const { return std::tie(cell, face) < std::tie(o.cell, o.face); }
  };
  std::vector<Entry> entries;
  for (Index f = 0; f < count; ++f) {
    const Vec3 &low = boxes[f].min(), &high = boxes[f].max();
    for (auto x = cell(low, 0); x <= cell(high, 0); ++x) {
      for (auto y = cell(low, 1); y <= cell(high, 1); ++y) {
        for (auto z = cell(low, 2); z <= cell(high, 2); ++z) entries.push_back({key(x, y, z), f});
      }
    }
  }
  context.run([&] { tbb::parallel_sort(entries); });
  std::vector<std::uint8_t> crosses(entries.size(), 0);
  const auto for_each_partner = [&](std::size_t e, const auto& body) {
    const auto& [own, f] = entries[e];
    for (std::size_t o = e + 1; o < entries.size() && entries[o].cell == own; ++o) {
      const Index g = entries[o].face;
      if (!boxes[f].intersects(boxes[g])) continue;
      const Vec3 low = boxes[f].min().cwiseMax(boxes[g].min());
      if (key(cell(low, 0), cell(low, 1), cell(low, 2)) == own && penetration(mesh, f, g) > 0) {
        body(g);
      }
    }
  };
  context.for_ranges(entries.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      for_each_partner(e, [&](Index) { crosses[e] = 1; });
    }
  });
  std::vector<std::array<Index, 2>> result;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (!crosses[e]) continue;
    for_each_partner(e, [&](Index g) { result.push_back({entries[e].face, g}); });
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace meshgrain
