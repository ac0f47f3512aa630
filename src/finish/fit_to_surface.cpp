#include "finish/fit_to_surface.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "measure/crossings.h"
#include "measure/face_shape.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 512;

class Fit {
 public:
  Fit(Extraction& extraction, const VertexFaces& around, Placement& placement,
      const Context& context)
      : mesh_(extraction.mesh),
        nodes_(extraction.nodes),
        around_(around),
        placement_(placement),
        context_(context) {}

  /// Along the surface.
  void draw_to_bends(float share) {
    take_samples();
    move_vertices([&](Index v) -> Vec3 {
      const Vec3 on = mesh_.positions[v] + share * to_bends(v);
      return placement_.place(on, v);
    });
  }

  /// Off it.
  void lift(float share) {
    take_samples();
    move_vertices([&](Index v) -> Vec3 { return mesh_.positions[v] + share * depth_around(v); });
  }

 private:
  /// One in the middle of each corner's share of a face: where that is on the face, and the surface
  /// beside it.
  struct Sample {
    Vec3 from;
    Projector::Plane surface;
  };

  void take_samples() {
    samples_.resize(mesh_.faces.corners().size());
    context_.for_ranges(mesh_.faces.size(), grain, [&](std::size_t begin, std::size_t end) {
      context_.check();
      for (auto f = static_cast<Index>(begin); f < end; ++f) {
        const auto face = std::as_const(mesh_.faces)[f];
        const std::size_t n = face.size();
        Vec3 center = Vec3::Zero();
        for (const Index v : face) center += mesh_.positions[v];
        center /= static_cast<float>(n);
        for (std::size_t k = 0; k < n; ++k) {
          const Vec3& p = mesh_.positions[face[k]];
          const Vec3& next = mesh_.positions[face[(k + 1) % n]];
          const Vec3& last = mesh_.positions[face[(k + n - 1) % n]];
          const Vec3 from = 0.5f * p + 0.125f * (next + last) + 0.25f * center;
          Index seed = nodes_[face[k]];
          const Vec3 point = placement_.projector().project(from, seed);
          samples_[mesh_.faces.first(f) + k] = {from, {point, placement_.projector().normal(seed)}};
        }
      }
    });
  }

  /// Calls use(sample, weight) for all in the faces around v. The weight is that of the function
  /// which falls from 1 at v to 0 at its neighbours.
  template <typename Use>
  void for_samples(Index v, const Use& use) const {
    for (const Index f : around_[v]) {
      const auto face = mesh_.faces[f];
      const std::size_t n = face.size();
      const auto at = corner_of(face, v);
      const Vec3& p = mesh_.positions[v];
      const Vec3 next = mesh_.positions[face[(at + 1) % n]] - p;
      const Vec3 last = mesh_.positions[face[(at + n - 1) % n]] - p;
      const float area = next.cross(last).norm();
      for (std::size_t k = 0; k < n; ++k) {
        const float own = k == at ? 0.5f : 0.0f;
        const float beside = k == (at + 1) % n || k == (at + n - 1) % n ? 0.125f : 0.0f;
        use(samples_[mesh_.faces.first(f) + k],
            area * (own + beside + 0.25f / static_cast<float>(n)));
      }
    }
  }

  /// The way along the surface towards the point that is nearest to all planes of the surface
  /// around v, by the mean of squares (Garland and Heckbert 1997).
  Vec3 to_bends(Index v) const {
    // Facing away: the other side of something thin.
    constexpr float least_cosine = -0.5f;
    // How strongly vertices are held: noise, and bends that are slight, should move none.
    constexpr float stiffness = 0.2f;
    const Vec3 normal = placement_.normal(v);
    Eigen::Matrix3f quadric = Eigen::Matrix3f::Zero();
    Vec3 slope = Vec3::Zero();
    float sum = 0;
    for_samples(v, [&](const Sample& sample, float weight) {
      const auto& [point, n] = sample.surface;
      if (n.dot(normal) < least_cosine) return;
      quadric += weight * n * n.transpose();
      slope += weight * n.dot(point - mesh_.positions[v]) * n;
      sum += weight;
    });
    if (!(sum > 0)) return Vec3::Zero();
    quadric += stiffness * sum * Eigen::Matrix3f::Identity();
    Vec3 way = quadric.ldlt().solve(slope);
    way -= way.dot(normal) * normal;
    const float length = way.norm(), most = longest_way(v);
    return length > most ? Vec3(most / length * way) : way;
  }

  /// How deep, along the normal of the surface at v, the faces around it lie under the surface: the
  /// median, as that leaves the least mean distance.
  Vec3 depth_around(Index v) const {
    const Vec3 normal = placement_.normal(v);
    std::vector<std::pair<float, float>> depths;  // and their weights
    float sum = 0;
    for_samples(v, [&](const Sample& sample, float weight) {
      depths.emplace_back((sample.surface.point - sample.from).dot(normal), weight);
      sum += weight;
    });
    if (!(sum > 0)) return Vec3::Zero();
    std::sort(depths.begin(), depths.end());
    float passed = 0;
    const auto middle = std::find_if(depths.begin(), depths.end(), [&](const auto& depth) {
      passed += depth.second;
      return passed >= 0.5f * sum;
    });
    const float depth = middle != depths.end() ? middle->first : depths.back().first;
    const float most = longest_way(v);
    return std::clamp(depth, -most, most) * normal;
  }

  /// What would be farther is no matter of a chord: something the mesh is too coarse for.
  float longest_way(Index v) const {
    constexpr float share = 0.15f;
    float sum = 0;
    for (const Index f : around_[v]) {
      const auto face = mesh_.faces[f];
      const std::size_t n = face.size();
      const auto at = corner_of(face, v);
      sum += (mesh_.positions[face[(at + 1) % n]] - mesh_.positions[v]).norm();
    }
    return share * sum / static_cast<float>(around_[v].size());
  }

  template <typename Move>
  void move_vertices(const Move& move) {
    std::vector<Vec3> next = mesh_.positions;
    context_.for_ranges(next.size(), grain, [&](std::size_t begin, std::size_t end) {
      context_.check();
      for (auto v = static_cast<Index>(begin); v < end; ++v) {
        if (placement_.is_free(v) && !around_[v].empty()) next[v] = move(v);
      }
    });
    mesh_.positions = std::move(next);
  }

  Mesh& mesh_;
  const std::vector<Index>& nodes_;
  const VertexFaces& around_;
  Placement& placement_;
  const Context& context_;
  std::vector<Sample> samples_;  // of every corner of a face
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

/// Puts the vertices back of faces that were nearly degenerate and became worse, and of those that
/// pass through others.
void put_spoiled_back(Mesh& mesh, const std::vector<Vec3>& before, const Context& context) {
  const auto put_back = [&](Index f) {
    bool changed = false;
    for (const Index v : std::as_const(mesh.faces)[f]) {
      changed = changed || mesh.positions[v] != before[v];
      mesh.positions[v] = before[v];
    }
    return changed;
  };
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

}  // namespace

void fit_to_surface(Extraction& extraction, const VertexFaces& around, Placement& placement,
                    double share, const Context& context) {
  const std::vector<Vec3> before = extraction.mesh.positions;
  Fit fit(extraction, around, placement, context);
  fit.draw_to_bends(static_cast<float>(share));
  fit.lift(static_cast<float>(share));
  put_spoiled_back(extraction.mesh, before, context);
}

}  // namespace meshgrain
