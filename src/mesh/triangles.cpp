#include "mesh/triangles.h"

#include <Eigen/Geometry>

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

}  // namespace

std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  const Faces& faces = mesh.faces;
  if (faces.empty()) return triangles;
  triangles.reserve(faces.corners().size() - 2 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    const std::size_t n = face.size();
    const std::size_t s = n == 4 && splits_at_one(mesh, face) ? 1 : 0;
    for (std::size_t k = 1; k + 1 < n; ++k)
      triangles.push_back({face[s], face[(s + k) % n], face[(s + k + 1) % n]});
  }
  return triangles;
}

}  // namespace meshgrain
