#include "finish/untangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "field/rosy.h"

namespace meshgrain {
namespace {

Vec3 area_vector(std::span<const Index> face, const std::vector<Vec3>& positions) {
  Vec3 sum = Vec3::Zero();
  const Vec3& first = positions[face[0]];
  for (std::size_t k = 2; k < face.size(); ++k) {
    sum += (positions[face[k - 1]] - first).cross(positions[face[k]] - first);
  }
  return 0.5f * sum;
}

/// What a face is worth: the least sine of its corners (a quad's scaled Jacobian), seen along the
/// normal of the face; negative where a corner is turned in, and below -1 if the whole face looks
/// away from `upward`, the normal of the surface.
float face_quality(std::span<const Index> face, const std::vector<Vec3>& positions,
                   const Vec3& upward) {
  const std::size_t n = face.size();
  Vec3 normal = area_vector(face, positions);
  const float length = normal.norm();
  if (!(length > 0)) return -1;
  normal /= length;
  float least = 1;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& p = positions[face[k]];
    const Vec3 a = positions[face[(k + 1) % n]] - p, b = positions[face[(k + n - 1) % n]] - p;
    const float lengths = a.norm() * b.norm();
    least = std::min(least, lengths > 0 ? normal.dot(a.cross(b)) / lengths : -1.0f);
  }
  const float towards = normal.dot(upward);
  return towards < 0 ? std::min(least, 0.0f) - 1 + towards : least;
}

class Untangling {
 public:
  Untangling(Extraction& extraction, const VertexFaces& around, Placement& placement)
      : mesh_(extraction.mesh), around_(around), placement_(placement) {
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      mean_area_ += area_vector(std::as_const(mesh_.faces)[f], mesh_.positions).norm() /
                    static_cast<float>(mesh_.faces.size());
    }
    tried_.resize(mesh_.positions.size(), 0);
    moved_.resize(mesh_.positions.size(), 0);
    normals_.resize(mesh_.positions.size());
    for (Index v = 0; v < normals_.size(); ++v) normals_[v] = placement_.normal(v);
    quality_.resize(mesh_.faces.size());
    for (Index f = 0; f < quality_.size(); ++f) quality_[f] = quality(f);
  }

  void run(const Context& context) {
    sweep(context);
    // A face before a feature is a face first.
    if (release_vertices()) sweep(context);
  }

 private:
  static constexpr float wanted = 0.75f;      // quality below which a face is looked at
  static constexpr float acceptable = 0.15f;  // below which its vertices leave their features

  void sweep(const Context& context) {
    constexpr int sweeps = 30;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      context.check();
      std::vector<Index> vertices;
      for (Index f = 0; f < quality_.size(); ++f) {
        if (quality_[f] >= wanted) continue;
        const auto face = std::as_const(mesh_.faces)[f];
        // The neighbours must make room.
        for (const Index v : face) {
          for (const Index g : around_[v]) {
            const auto other = std::as_const(mesh_.faces)[g];
            vertices.insert(vertices.end(), other.begin(), other.end());
          }
        }
      }
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      const std::uint32_t before = now_;
      for (const Index v : vertices) {
        if (!has_news(v)) continue;
        tried_[v] = ++now_;
        if (improve(v)) moved_[v] = ++now_;
      }
      const bool any = std::any_of(vertices.begin(), vertices.end(),
                                   [&](Index v) { return moved_[v] > before; });
      if (!any) break;
    }
  }

  /// Whether something has moved around v since it was last tried.
  bool has_news(Index v) const {
    if (tried_[v] == 0) return true;
    for (const Index f : around_[v]) {
      for (const Index w : std::as_const(mesh_.faces)[f]) {
        if (moved_[w] > tried_[v]) return true;
      }
    }
    return false;
  }

  bool release_vertices() {
    const std::uint32_t before = now_;
    for (Index f = 0; f < quality_.size(); ++f) {
      if (quality_[f] >= acceptable) continue;
      for (const Index v : std::as_const(mesh_.faces)[f]) {
        if (placement_.release(v)) moved_[v] = ++now_;
      }
    }
    return now_ > before;
  }

  float quality(Index f) const {
    const auto face = std::as_const(mesh_.faces)[f];
    Vec3 upward = Vec3::Zero();
    for (const Index v : face) upward += normals_[v];
    return face_quality(face, mesh_.positions, upward.normalized());
  }

  /// What the faces around a vertex lack, the worst counting most, and how uneven they are.
  double lack(Index v) const {
    double sum = 0;
    for (const Index f : around_[v]) {
      const double q = quality(f);
      const double best =
          std::sin(2 * std::numbers::pi / static_cast<double>(mesh_.faces.degree(f)));
      const double irregular = std::max(0.0, best - q), bad = std::max(0.0, wanted - q);
      sum += irregular * irregular + 10 * bad * bad;
      const float area = area_vector(std::as_const(mesh_.faces)[f], mesh_.positions).norm();
      const double uneven = std::log(std::max(area / mean_area_, 1e-3f));
      sum += 0.1 * uneven * uneven;
    }
    return sum;
  }

  bool improve(Index v) {
    if (placement_.is_fixed(v) || around_[v].empty()) return false;
    const double before = lack(v);
    if (before < 1e-6) return false;
    const Vec3 x = any_tangent(normals_[v]), y = normals_[v].cross(x);
    float length = 0;
    for (const Index f : around_[v]) {
      const auto face = std::as_const(mesh_.faces)[f];
      for (std::size_t k = 0; k < face.size(); ++k) {
        length += (mesh_.positions[face[k]] - mesh_.positions[face[(k + 1) % face.size()]]).norm() /
                  static_cast<float>(face.size() * around_[v].size());
      }
    }
    Vec3 best = mesh_.positions[v];
    Placement::Seed best_seed = placement_.seed(v);
    double least = before;
    const auto attempt = [&](const Vec3& target) {
      placement_.set_seed(v, best_seed);
      mesh_.positions[v] = placement_.place(target, v);
      const double now = lack(v);
      if (now < least) {
        least = now;
        best = mesh_.positions[v];
        best_seed = placement_.seed(v);
      }
    };
    Vec3 center = Vec3::Zero();
    float count = 0;
    for (const Index f : around_[v]) {
      for (const Index w : std::as_const(mesh_.faces)[f]) {
        if (w == v) continue;
        center += mesh_.positions[w];
        ++count;
      }
    }
    attempt(center / count);
    constexpr int directions = 8;
    for (float step = 0.5f * length; step > 0.03f * length; step /= 2) {
      const Vec3 from = best;
      for (int k = 0; k < directions; ++k) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / directions;
        attempt(from + step * (std::cos(angle) * x + std::sin(angle) * y));
      }
    }
    mesh_.positions[v] = best;
    placement_.set_seed(v, best_seed);
    if (least > 0.99 * before) return false;
    normals_[v] = placement_.normal(v);
    for (const Index f : around_[v]) quality_[f] = quality(f);
    return true;
  }

  Mesh& mesh_;
  const VertexFaces& around_;
  Placement& placement_;
  std::vector<float> quality_;  // of each face
  std::vector<Vec3> normals_;   // of the surface, where each vertex is
  float mean_area_ = 0;
  std::uint32_t now_ = 0;                      // counts tries and moves
  std::vector<std::uint32_t> tried_, moved_;  // when each vertex last was
};

}  // namespace

void untangle(Extraction& extraction, const VertexFaces& around, Placement& placement,
              const Context& context) {
  Untangling(extraction, around, placement).run(context);
}

}  // namespace meshgrain
