#include "mesh/triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

#include "meshgrain/triangulate.h"

namespace meshgrain {
namespace {

/// Whether the quad's better diagonal runs from corner 1 to corner 3.
bool splits_at_one(const Mesh& mesh, std::span<const Index> quad) {
  const auto corner = [&](int k) { return mesh.positions[quad[k % 4]].cast<double>(); };
  const auto normal = [&](int a, int b, int c) {
    return (corner(b) - corner(a)).cross(corner(c) - corner(a)).eval();
  };
  const bool good0 = normal(0, 1, 2).dot(normal(0, 2, 3)) > 0;
  const bool good1 = normal(1, 2, 3).dot(normal(1, 3, 4)) > 0;
  if (good0 != good1) return good1;
  return (corner(1) - corner(3)).squaredNorm() < (corner(0) - corner(2)).squaredNorm();
}

/// Whether the triangles of a fan from the first corner all face the side that the polygon does.
bool is_fan(const Mesh& mesh, std::span<const Index> face) {
  const Eigen::Vector3d base = mesh.positions[face[0]].cast<double>();
  std::vector<Eigen::Vector3d> normals;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    const Eigen::Vector3d to = mesh.positions[face[k]].cast<double>() - base;
    normals.emplace_back(to.cross(mesh.positions[face[k + 1]].cast<double>() - base));
    sum += normals.back();
  }
  return std::ranges::all_of(normals, [&](const auto& n) { return n.dot(sum) >= 0; });
}

void clip_ears(const Mesh& mesh, std::span<const Index> face, std::vector<Triangle>& triangles) {
  Mesh alone;
  std::vector<Index> corners;
  for (const Index v : face) {
    corners.push_back(static_cast<Index>(corners.size()));
    alone.positions.push_back(mesh.positions[v]);
  }
  alone.faces.push_back(corners);
  const Faces clipped = triangulate(alone).faces;
  for (std::size_t t = 0; t < clipped.size(); ++t) {
    const auto corner = clipped[t];
    triangles.push_back({face[corner[0]], face[corner[1]], face[corner[2]]});
  }
}

}  // namespace

std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  const Faces& faces = mesh.faces;
  if (faces.empty()) return triangles;
  triangles.reserve(faces.corners().size() - 2 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    const std::size_t n = face.size();
    if (n > 4 && !is_fan(mesh, face)) {
      clip_ears(mesh, face, triangles);
      continue;
    }
    const std::size_t s = n == 4 && splits_at_one(mesh, face) ? 1 : 0;
    for (std::size_t k = 1; k + 1 < n; ++k)
      triangles.push_back({face[s], face[(s + k) % n], face[(s + k + 1) % n]});
  }
  return triangles;
}

}  // namespace meshgrain
