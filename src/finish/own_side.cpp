#include "finish/own_side.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "field/rosy.h"
#include "finish/crossing_guard.h"
#include "finish/near_surface.h"
#include "finish/vertex_batches.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "mesh/box_cells.h"
#include "util/indices.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

class OwnSide {
 public:
  OwnSide(Mesh& mesh, const VertexFaces& around, const Placement& placement, const PolygonFit& fit,
          const Context& context)
      : mesh_(mesh), around_(around), placement_(placement), fit_(fit), context_(context) {}

  void run(const std::vector<Vec3>& normals) {
    std::vector<Index> watched = turned_faces(bent_faces(normals));
    if (watched.empty()) return;
    const BoxCells cells = cells_around(watched, reach);
    const NearSurface near(placement_.projector().surface(), cells, context_);
    near_ = &near;
    movable_ = vertices_of(mesh_, with_rings(mesh_, around_, watched, 1));
    std::erase_if(movable_, [&](Index v) { return placement_.is_on_line(v); });
    before_ = mesh_.positions;
    CrossingGuard guard(mesh_, faces_in(cells), context_);
    VertexBatches batches(mesh_, around_);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      context_.check();
      shift_samples(sweep);
      measure(watched, many_samples);
      const std::vector<Index> vertices = vertices_of_turned(watched);
      for (const std::vector<Index>& batch : batches(vertices)) {
        context_.for_ranges(batch.size(), 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) improve(batch[k]);
        });
      }
      guard.undo_new();
      for (const Index v : vertices) {
        watched.insert(watched.end(), around_[v].begin(), around_[v].end());
      }
      sort_unique(watched);
    }
  }

 private:
  // Each with the samples elsewhere in the faces: what is between them does not stay unseen.
  static constexpr int sweeps = 3;
  static constexpr int most_samples = 3, many_samples = 2,
                       few_samples = 1;  // of a triangle, squared

  // What a face lacks, in all of its area on the wrong side.
  static constexpr float for_distance = 0.6f;    // the mean, in lengths of a side
  static constexpr float for_unevenness = 0.2f;  // the square of how much its area is off
  static constexpr float for_corners = 0.2f;     // the squares of how much their cosines are off
  static constexpr float least_gain = 1e-3f;

  // In lengths of a side.
  static constexpr float first_step = 0.15f, last_step = 0.05f, farthest = 0.5f;
  static constexpr float reach = 2;                // of what is looked at around a turned face
  static constexpr float reach_of_samples = 0.5f;  // around one that is bent

  struct Sample {
    float distance;  // from the surface, in lengths of a side
    bool is_turned;
  };

  std::span<const Index> face(Index f) const { return std::as_const(mesh_.faces)[f]; }

  float side(Index v) const { return fit_.side * fit_.relative_size[v]; }

  /// Faces that look elsewhere than the surface does at one of their corners: most of those with
  /// parts on the wrong side are among them, and they are found at once.
  std::vector<Index> bent_faces(const std::vector<Vec3>& normals) const {
    constexpr float bent = 0.6f;  // cosine
    const auto is_bent = [&](Index f) {
      const Vec3 normal = area_vector(face(f), mesh_.positions).stableNormalized();
      return std::ranges::any_of(face(f), [&](Index v) { return normal.dot(normals[v]) < bent; });
    };
    return indices_where(mesh_.faces.size(), is_bent, context_);
  }

  /// Of some faces, those with a sample on the wrong side.
  std::vector<Index> turned_faces(const std::vector<Index>& faces) {
    if (faces.empty()) return {};
    turned_.assign(mesh_.faces.size(), 0);
    const BoxCells cells = cells_around(faces, reach_of_samples);
    const NearSurface near(placement_.projector().surface(), cells, context_);
    near_ = &near;
    shift_samples(0);
    measure(faces, most_samples);
    near_ = nullptr;
    return turned_among(faces);
  }

  /// As they were measured last.
  std::vector<Index> turned_among(const std::vector<Index>& faces) const {
    std::vector<Index> turned;
    std::ranges::copy_if(faces, std::back_inserter(turned),
                         [&](Index f) { return turned_[f] > 0; });
    return turned;
  }

  BoxCells cells_around(const std::vector<Index>& faces, float margins) const {
    std::vector<Eigen::AlignedBox3f> boxes;
    for (const Index f : faces) {
      Eigen::AlignedBox3f box = face_box(mesh_, f);
      const Vec3 margin = Vec3::Constant(margins * side(face(f)[0]));
      boxes.emplace_back(box.min() - margin, box.max() + margin);
    }
    return {boxes, 0.5f * fit_.side};
  }

  /// To the next of a sequence of low discrepancy (the additive recurrence R2).
  void shift_samples(int sweep) {
    constexpr float along = 0.7548777f, across = 0.5698403f;
    const auto n = static_cast<float>(sweep);
    shift_ = {1 / 3.0f + n * along, 1 / 3.0f + n * across};
    for (float& shift : shift_) shift -= std::floor(shift);
  }

  void measure(std::span<const Index> faces, int samples_a_side) {
    context_.for_ranges(faces.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (const Index f : faces.subspan(begin, end - begin)) measure(f, samples_a_side);
    });
  }

  void measure(Index f, int samples_a_side) {
    turned_[f] = 0;
    for_samples(f, no_index, samples_a_side, [&](float share, const Sample& sample) {
      if (sample.is_turned) turned_[f] += share;
      return true;
    });
  }

  std::vector<Index> vertices_of_turned(const std::vector<Index>& faces) const {
    std::vector<Index> vertices = vertices_of(mesh_, turned_among(faces));
    std::erase_if(vertices, [&](Index v) { return !std::ranges::binary_search(movable_, v); });
    return vertices;
  }

  float wanted_area(Index f) const {
    const auto n = static_cast<float>(face(f).size());
    float length = 0;
    for (const Index v : face(f)) length += side(v) / n;
    return length * length * n / (4 * std::tan(std::numbers::pi_v<float> / n));
  }

  float lack_of_shape(Index f) const {
    const auto corners = face(f);
    const std::size_t n = corners.size();
    const float off = area_vector(corners, mesh_.positions).norm() / wanted_area(f) - 1;
    float sum = for_unevenness * off * off;
    const float regular = -std::cos(2 * std::numbers::pi_v<float> / static_cast<float>(n));
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3& p = mesh_.positions[corners[k]];
      const Vec3 ahead = mesh_.positions[corners[(k + 1) % n]] - p;
      const Vec3 back = mesh_.positions[corners[(k + n - 1) % n]] - p;
      const float lengths = ahead.norm() * back.norm();
      const float cosine = lengths > 0 ? ahead.dot(back) / lengths : 1;
      sum += for_corners * (cosine - regular) * (cosine - regular);
    }
    return sum;
  }

  /// Calls use(share, found) for samples of a face as most programs draw it, in triangles around
  /// its first corner, while it returns true: with the share of a face's wanted area that each
  /// stands for, and what of the surface is nearest to it. Only those that move with a vertex, if
  /// one is told.
  template <typename Use>
  void for_samples(Index f, Index moving, int samples_a_side, const Use& use) const {
    const auto corners = face(f);
    const Vec3& a = mesh_.positions[corners[0]];
    const float length = side(corners[0]), area = wanted_area(f);
    const auto n = static_cast<float>(samples_a_side);
    Vec3 last = a;
    float near = length;  // of `last`, to the surface
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const bool moves = moving == no_index || moving == corners[0] || moving == corners[k - 1] ||
                         moving == corners[k];
      if (!moves) continue;
      const Vec3 b = mesh_.positions[corners[k - 1]] - a, c = mesh_.positions[corners[k]] - a;
      const Vec3 normal = b.cross(c);
      const float share = normal.norm() / (2 * area * (n * n));
      for (int i = 0; i < samples_a_side; ++i) {
        for (int j = 0; j < samples_a_side; ++j) {
          float x = (static_cast<float>(i) + shift_[0]) / n;
          float y = (static_cast<float>(j) + shift_[1]) / n;
          if (x + y > 1) x = 1 - x, y = 1 - y;
          const Vec3 p = a + x * b + y * c;
          const float limit = std::min(length, 1.01f * (near + (p - last).norm()));
          const auto [distance, upward] = near_->nearest(p, limit);
          if (!use(share, Sample{distance / length, upward.dot(normal) < 0})) return;
          last = p;
          near = distance;
        }
      }
    }
  }

  float quality(Index f) const {
    return least_sine(face(f), mesh_.positions,
                      area_vector(face(f), mesh_.positions).stableNormalized());
  }

  /// Of the faces around a vertex, as far as it depends on that; from `limit` on it need not be
  /// exact.
  float lack(Index v, float limit) const {
    float sum = 0;
    for (const Index f : around_[v]) sum += lack_of_shape(f);
    for (const Index f : around_[v]) {
      const int samples = turned_[f] > 0 ? many_samples : few_samples;
      for_samples(f, v, samples, [&](float share, const Sample& sample) {
        sum += share * (for_distance * sample.distance + (sample.is_turned ? 1.0f : 0.0f));
        return sum < limit;
      });
    }
    return sum;
  }

  /// Tries places for a vertex, off the surface and along it (Hooke and Jeeves 1961).
  void improve(Index v) {
    const auto faces = around_[v];
    if (std::ranges::none_of(faces, [&](Index f) { return turned_[f] > 0; })) return;
    Vec3 normal = Vec3::Zero();
    for (const Index f : faces) normal += area_vector(face(f), mesh_.positions);
    if (normal.isZero(0)) return;
    normal.normalize();
    const Vec3 x = any_tangent(normal), y = normal.cross(x);
    const Vec3 ways[] = {normal, -normal, x, -x, y, -y};
    const Vec3 here = mesh_.positions[v];
    const std::vector<float> qualities = least_qualities(v);
    float least = lack(v, std::numeric_limits<float>::infinity());
    constexpr int rounds = 3;
    for (float step = first_step; step >= 0.99f * last_step; step /= 3) {
      bool moved = true;
      for (int round = 0; round < rounds && moved; ++round) {
        moved = false;
        for (const Vec3& way : ways) {
          moved = attempt(v, step * side(v) * way, qualities, least) || moved;
        }
      }
    }
    if (mesh_.positions[v] == here) return;
    for (const Index f : faces) measure(f, many_samples);
  }

  /// Moves v if that leaves less than the least so far.
  bool attempt(Index v, const Vec3& way, const std::vector<float>& qualities, float& least) {
    Vec3& position = mesh_.positions[v];
    const Vec3 here = position;
    position += way;
    if ((position - before_[v]).norm() <= farthest * side(v) && placement_.allows(position, v) &&
        keeps(v, qualities)) {
      const float left = lack(v, least - least_gain);
      if (left < least - least_gain) {
        least = left;
        return true;
      }
    }
    position = here;
    return false;
  }

  /// Of each face around a vertex: as good as is seen nowhere, or as it is.
  std::vector<float> least_qualities(Index v) const {
    std::vector<float> qualities;
    for (const Index f : around_[v]) {
      const auto n = static_cast<float>(face(f).size());
      const float good = 0.72f * std::sin(2 * std::numbers::pi_v<float> / n);
      qualities.push_back(std::min(quality(f), good));
    }
    return qualities;
  }

  bool keeps(Index v, const std::vector<float>& qualities) const {
    for (std::size_t k = 0; k < around_[v].size(); ++k) {
      if (quality(around_[v][k]) < qualities[k]) return false;
    }
    return true;
  }

  std::vector<Index> faces_in(const BoxCells& cells) const {
    const auto is_in = [&](Index f) { return cells.touches(face_box(mesh_, f)); };
    return indices_where(mesh_.faces.size(), is_in, context_);
  }

  Mesh& mesh_;
  const VertexFaces& around_;
  const Placement& placement_;
  const PolygonFit& fit_;
  const Context& context_;
  const NearSurface* near_ = nullptr;
  std::vector<Index> movable_;           // the free vertices of bent faces
  std::vector<Vec3> before_;             // positions
  std::vector<float> turned_;            // of each face, in wanted areas
  std::array<float, 2> shift_ = {0, 0};  // of the samples
};

}  // namespace

void keep_to_own_side(Mesh& mesh, const VertexFaces& around, const Placement& placement,
                      const std::vector<Vec3>& normals, const PolygonFit& fit,
                      const Context& context) {
  OwnSide(mesh, around, placement, fit, context).run(normals);
}

}  // namespace meshgrain
