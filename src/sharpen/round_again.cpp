#include "sharpen/round_again.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "measure/bvh.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "meshgrain/normals.h"

namespace meshgrain {
namespace {

/// Where vertices would be on the roundings; where they are if they are not of these.
std::vector<Vec3> rounded_positions(const Mesh& mesh, const Roundings& roundings,
                                    const Context& context) {
  std::vector<Vec3> positions = mesh.positions;
  const std::vector<Vec3> normals = vertex_normals(mesh, -1, context);
  const std::vector<std::uint8_t> on_rim = rim_vertices(mesh, context);
  const std::vector<Vec3>& at = roundings.triangles.positions;
  const Eigen::Vector3d offset = mesh.origin - roundings.triangles.origin;
  const Bvh tree(roundings.triangles);
  const double reach = 0.6 * roundings.widest;     // as far is the corner where three of them meet
  constexpr double same_side = 0.5, beside = 0.5;  // the cosines of angles
  const auto put = [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (on_rim[v]) continue;
      const Eigen::Vector3d p = mesh.positions[v].cast<double>() + offset;
      const Bvh::Hit hit = tree.closest(p, reach * reach);
      if (hit.triangle == no_index) continue;
      const auto& [a, b, c] = tree.triangles()[hit.triangle];
      const Eigen::Vector3d normal =
          (at[b] - at[a]).cross(at[c] - at[a]).stableNormalized().cast<double>();
      // Vertices beside a rounding are nearest to where it ends.
      const bool is_over = std::abs(normal.dot(p - hit.point)) >= beside * (p - hit.point).norm();
      if (is_over && normal.dot(normals[v].cast<double>()) > same_side) {
        positions[v] = (hit.point - offset).cast<float>();
      }
    }
  };
  context.for_ranges(positions.size(), 1024, put);
  return positions;
}

float quality(std::span<const Index> face, const std::vector<Vec3>& positions) {
  return least_sine(face, positions, area_vector(face, positions).normalized());
}

}  // namespace

void Roundings::add(const Roundings& more) {
  if (more.triangles.faces.empty()) return;
  if (triangles.faces.empty()) triangles.origin = more.triangles.origin;
  const Eigen::Vector3d offset = more.triangles.origin - triangles.origin;
  const auto first = static_cast<Index>(triangles.positions.size());
  for (const Vec3& p : more.triangles.positions) {
    triangles.positions.push_back((p.cast<double>() + offset).cast<float>());
  }
  for (std::size_t f = 0; f < more.triangles.faces.size(); ++f) {
    const auto face = more.triangles.faces[f];
    triangles.faces.push_back({first + face[0], first + face[1], first + face[2]});
  }
  widest = std::max(widest, more.widest);
}

void round_again(Mesh& mesh, const Roundings& roundings, const Context& context) {
  if (roundings.triangles.faces.empty()) return;
  const std::vector<Vec3> sharp = mesh.positions;
  mesh.positions = rounded_positions(mesh, roundings, context);
  constexpr float poor = 0.1f;
  for (bool any = true; std::exchange(any, false);) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = std::as_const(mesh.faces)[f];
      if (quality(face, mesh.positions) >= std::min(poor, quality(face, sharp))) continue;
      for (const Index v : face) {
        any = any || mesh.positions[v] != sharp[v];
        mesh.positions[v] = sharp[v];
      }
    }
  }
}

}  // namespace meshgrain
