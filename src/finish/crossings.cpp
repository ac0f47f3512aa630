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

/// The triangles of a face: of a quad, those on either side of both diagonals.
template <typename Body>
void for_each_triangle(std::span<const Index> face, const Body& body) {
  for (std::size_t k = 2; k < face.size(); ++k) body(Corners{face[0], face[k - 1], face[k]});
  if (face.size() != 4) return;
  body(Corners{face[1], face[2], face[3]});
  body(Corners{face[1], face[3], face[0]});
}

// Faces are taken a little larger than they are, so that what only touches counts too.
constexpr double margin = 1e-3;

using Points = std::array<Eigen::Vector3d, 3>;

/// Whether a triangle lies on one side of the plane through the first point of `plane`.
bool beside(const Points& triangle, const Points& plane, const Eigen::Vector3d& normal) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector3d& p : triangle) {
    const double height = normal.dot(p - plane[0]);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  const double more = margin * (high - low);
  return low - more > 0 || high + more < 0;
}

/// How far the nearer end of a segment lies beyond a triangle that it passes through, else 0.
double depth(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Points& triangle,
             const Eigen::Vector3d& normal) {
  const Eigen::Vector3d u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Eigen::Vector3d more = margin * (q - p);
  const Eigen::Vector3d s = p - more - triangle[0], t = q + more - triangle[0];
  const double ds = normal.dot(s), dt = normal.dot(t);
  if (!(ds * dt < 0)) return 0;
  const Eigen::Vector3d x = s + ds / (ds - dt) * (t - s);
  const double outside = -margin * normal.squaredNorm();
  if (normal.dot(u.cross(x)) < outside || normal.dot((v - u).cross(x - u)) < outside ||
      normal.dot(x.cross(v)) < outside) {
    return 0;
  }
  return std::min(std::abs(ds), std::abs(dt)) / normal.norm();
}

double triangle_penetration(const std::vector<Vec3>& positions, const Corners& t,
                            const Corners& u) {
  int shared = 0, own = 0, other = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (t[i] != u[j]) continue;
      ++shared;
      own = i;
      other = j;
    }
  }
  if (shared > 1) return 0;
  Points a, b;
  for (int k = 0; k < 3; ++k) {
    a[k] = positions[t[k]].cast<double>();
    b[k] = positions[u[k]].cast<double>();
  }
  const auto normal_of = [](const Points& p) -> Eigen::Vector3d {
    return (p[1] - p[0]).cross(p[2] - p[0]);
  };
  const Eigen::Vector3d normal_a = normal_of(a), normal_b = normal_of(b);
  const auto edge_of_a = [&](int k) { return depth(a[k], a[(k + 1) % 3], b, normal_b); };
  const auto edge_of_b = [&](int k) { return depth(b[k], b[(k + 1) % 3], a, normal_a); };
  // At a shared corner only the edges opposite of it can pass through.
  if (shared == 1) return edge_of_a((own + 1) % 3) + edge_of_b((other + 1) % 3);
  if (beside(b, a, normal_a) || beside(a, b, normal_b)) return 0;
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += edge_of_a(k) + edge_of_b(k);
  return sum;
}

}  // namespace

Eigen::AlignedBox3f face_box(const Mesh& mesh, Index f) {
  Eigen::AlignedBox3f box;
  for (const Index v : mesh.faces[f]) box.extend(mesh.positions[v]);
  return box;
}

double penetration(const Mesh& mesh, Index f, Index g) {
  if (f == g || !face_box(mesh, f).intersects(face_box(mesh, g))) return 0;
  double sum = 0;
  for_each_triangle(mesh.faces[f], [&](const Corners& t) {
    for_each_triangle(mesh.faces[g],
                      [&](const Corners& u) { sum += triangle_penetration(mesh.positions, t, u); });
  });
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
