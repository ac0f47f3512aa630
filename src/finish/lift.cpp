#include "finish/lift.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "finish/crossings.h"
#include "finish/face_shape.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 512;

/// How far, along the normal of the surface at a vertex, the faces around it lie under the surface
/// on average: each as its middle and those of its edges say by Simpson's rule, with the weights
/// of a function that falls from 1 at the vertex to 0 at its neighbours.
class Lift {
 public:
  Lift(const Extraction& extraction, const VertexFaces& around, const Placement& placement)
      : mesh_(extraction.mesh), nodes_(extraction.nodes), around_(around), placement_(placement) {}

  Vec3 of(Index v) const {
    const Vec3& p = mesh_.positions[v];
    const Vec3 normal = placement_.normal(v);
    float sum = 0, area = 0, edges = 0, ends = 0;
    for (const Index f : around_[v]) {
      const auto face = mesh_.faces[f];
      const std::size_t n = face.size();
      const auto at =
          static_cast<std::size_t>(std::find(face.begin(), face.end(), v) - face.begin());
      const Vec3 next = mesh_.positions[face[(at + 1) % n]];
      const Vec3 last = mesh_.positions[face[(at + n - 1) % n]];
      Vec3 center = Vec3::Zero();
      for (const Index w : face) center += mesh_.positions[w];
      center /= static_cast<float>(n);
      const float weight = (next - p).cross(last - p).norm();
      const float beside =
          depth(0.5f * (p + next), v, normal) + depth(0.5f * (p + last), v, normal);
      sum += weight * (n == 3 ? beside / 2 : (2 * beside + 4 * depth(center, v, normal)) / 9);
      area += weight;
      edges += (next - p).norm() + (last - p).norm();
      ends += 2;
    }
    if (!(area > 0)) return Vec3::Zero();
    // More than that is no matter of a chord: something the mesh is too coarse for.
    const float most = 0.15f * edges / ends;
    return std::clamp(sum / area, -most, most) * normal;
  }

 private:
  float depth(const Vec3& p, Index v, const Vec3& normal) const {
    Index seed = nodes_[v];
    return (placement_.projector().project(p, seed) - p).dot(normal);
  }

  const Mesh& mesh_;
  const std::vector<Index>& nodes_;
  const VertexFaces& around_;
  const Placement& placement_;
};

/// The least sine of a face's corners, seen along the mean of their normals.
float worst_corner(std::span<const Index> face, const std::vector<Vec3>& positions) {
  const std::size_t n = face.size();
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& p = positions[face[k]];
    const Vec3 a = positions[face[(k + 1) % n]] - p, b = positions[face[(k + n - 1) % n]] - p;
    if (const float lengths = a.norm() * b.norm(); lengths > 0) normal += a.cross(b) / lengths;
  }
  const float length = normal.norm();
  return length > 0 ? least_sine(face, positions, normal / length) : -1;
}

}  // namespace

void lift_vertices(Extraction& extraction, const VertexFaces& around, const Placement& placement,
                   double share, const Context& context) {
  Mesh& mesh = extraction.mesh;
  const std::vector<Vec3> before = mesh.positions;
  std::vector<Vec3> lifted = before;
  const Lift lift(extraction, around, placement);
  context.for_ranges(before.size(), grain, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (placement.is_free(v)) lifted[v] += static_cast<float>(share) * lift.of(v);
    }
  });
  mesh.positions = std::move(lifted);
  const auto put_back = [&](Index f) {
    bool changed = false;
    for (const Index v : std::as_const(mesh.faces)[f]) {
      changed = changed || mesh.positions[v] != before[v];
      mesh.positions[v] = before[v];
    }
    return changed;
  };
  // Faces that were nearly degenerate and became worse go back, and those that pass through others.
  constexpr float good = 0.3f;
  for (bool changed = true; changed;) {
    changed = false;
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const auto face = std::as_const(mesh.faces)[f];
      const float sine = worst_corner(face, mesh.positions);
      if (sine < good && sine < worst_corner(face, before)) changed = put_back(f) || changed;
    }
    for (const auto& [f, g] : find_crossings(mesh, context)) {
      changed = put_back(f) || changed;
      changed = put_back(g) || changed;
    }
  }
}

}  // namespace meshgrain
