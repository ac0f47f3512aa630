#include "sharpen/round_again.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "measure/bvh.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "mesh/border.h"
#include "meshgrain/normals.h"

namespace meshgrain {
namespace {

/// Where roundings are, from where their sharp edges were.
class Roundings {
 public:
  explicit Roundings(const Mesh& roundings) : mesh_(roundings) {
    // Apart by where they face, as the other side of a thin wall may be nearer.
    for (int way = 0; way < 6; ++way) {
      std::vector<Triangle> facing;
      for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
        const auto face = mesh_.faces[f];
        const Triangle triangle{face[0], face[1], face[2]};
        constexpr double about = 0.5;
        if (along(way, normal(triangle)) > about) facing.push_back(triangle);
      }
      if (!facing.empty()) trees_[way] = std::make_unique<Bvh>(mesh_.positions, std::move(facing));
    }
    for (const float value : mesh_.values) reach_ = std::max<double>(reach_, value);
  }

  /// Where a vertex of that normal goes; `p` itself if it is over none.
  Eigen::Vector3d rounded(const Eigen::Vector3d& p, const Eigen::Vector3d& vertex_normal) const {
    Eigen::Vector3d best = p;
    double least = reach_ * reach_;
    for (int way = 0; way < 6; ++way) {
      if (trees_[way] == nullptr || !(along(way, vertex_normal) > 0)) continue;
      const Bvh::Hit hit = trees_[way]->closest(p, least);
      if (hit.triangle == no_index) continue;
      const Triangle& triangle = trees_[way]->triangles()[hit.triangle];
      if (!is_over(p, vertex_normal, hit.point, triangle)) continue;
      least = hit.squared_distance;
      best = hit.point;
    }
    return best;
  }

 private:
  using Triangle = std::array<Index, 3>;

  static double along(int way, const Eigen::Vector3d& direction) {
    return way < 3 ? direction[way] : -direction[way - 3];
  }

  Eigen::Vector3d normal(const Triangle& triangle) const {
    const auto& [a, b, c] = triangle;
    const std::vector<Vec3>& at = mesh_.positions;
    return (at[b] - at[a]).cross(at[c] - at[a]).stableNormalized().cast<double>();
  }

  /// Vertices beside a rounding are nearest to where it ends, and far from along its normal.
  bool is_over(const Eigen::Vector3d& p, const Eigen::Vector3d& vertex_normal,
               const Eigen::Vector3d& nearest, const Triangle& triangle) const {
    constexpr double same_side = 0.5, over = 0.5;  // the cosines of angles
    constexpr double farther = 1.01;
    float reach = 0;
    for (const Index v : triangle) reach = std::max(reach, mesh_.values[v]);
    const Eigen::Vector3d n = normal(triangle);
    const double distance = (p - nearest).norm();
    return distance <= farther * reach && n.dot(vertex_normal) > same_side &&
           std::abs(n.dot(p - nearest)) >= over * distance;
  }

  const Mesh& mesh_;
  std::array<std::unique_ptr<Bvh>, 6> trees_;
  double reach_ = 0;
};

/// Of a face seen along its own normal; below 0 if it has turned over.
float quality(std::span<const Index> face, const std::vector<Vec3>& positions, const Vec3& before) {
  const Vec3 area = area_vector(face, positions);
  return area.dot(before) > 0 ? least_sine(face, positions, area.normalized()) : -1;
}

/// Vertices of faces that are poor now, and were not before, go back.
void take_back_poor(Mesh& mesh, const std::vector<Vec3>& sharp, const Context& context) {
  constexpr float poor = 0.1f;
  for (bool any = true; std::exchange(any, false);) {
    context.check();
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = std::as_const(mesh.faces)[f];
      const Vec3 before = area_vector(face, sharp);
      if (quality(face, mesh.positions, before) >= std::min(poor, quality(face, sharp, before))) {
        continue;
      }
      for (const Index v : face) {
        any = any || mesh.positions[v] != sharp[v];
        mesh.positions[v] = sharp[v];
      }
    }
  }
}

}  // namespace

void round_again(Mesh& mesh, const Mesh& roundings, const Context& context) {
  if (roundings.faces.empty()) return;
  const std::vector<Vec3> sharp = mesh.positions;
  const std::vector<Vec3> normals = vertex_normals(mesh, -1, context);
  const std::vector<std::uint8_t> on_rim = rim_vertices(mesh, context);
  const Eigen::Vector3d offset = mesh.origin - roundings.origin;
  const Roundings targets(roundings);
  const auto put = [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (on_rim[v]) continue;
      const Eigen::Vector3d p = sharp[v].cast<double>() + offset;
      const Eigen::Vector3d now = targets.rounded(p, normals[v].cast<double>());
      if (now != p) mesh.positions[v] = (now - offset).cast<float>();
    }
  };
  context.for_ranges(sharp.size(), 1024, put);
  take_back_poor(mesh, sharp, context);
  const std::size_t crossings = find_crossings(mesh, context).size();
  if (crossings == 0) return;
  std::vector<Vec3> round = std::exchange(mesh.positions, sharp);
  if (find_crossings(mesh, context).size() >= crossings) mesh.positions = std::move(round);
}

void add_triangles(Mesh& roundings, const Mesh& more) {
  if (roundings.faces.empty()) roundings.origin = more.origin;
  const Eigen::Vector3d offset = more.origin - roundings.origin;
  const auto first = static_cast<Index>(roundings.positions.size());
  for (const Vec3& p : more.positions) {
    roundings.positions.push_back((p.cast<double>() + offset).cast<float>());
  }
  roundings.values.insert(roundings.values.end(), more.values.begin(), more.values.end());
  for (std::size_t f = 0; f < more.faces.size(); ++f) {
    const auto face = more.faces[f];
    roundings.faces.push_back({first + face[0], first + face[1], first + face[2]});
  }
}

}  // namespace meshgrain
