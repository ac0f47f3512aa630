#include "finish/local_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "field/rosy.h"
#include "finish/turned_over.h"
#include "measure/crossings.h"
#include "measure/face_shape.h"
#include "util/sort_unique.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

constexpr float diagonal = std::numbers::sqrt2_v<float> / 2;
constexpr float directions[][2] = {{1, 0},  {diagonal, diagonal},   {0, 1},  {-diagonal, diagonal},
                                   {-1, 0}, {-diagonal, -diagonal}, {0, -1}, {diagonal, -diagonal}};

/// Of a regular polygon with n corners.
float best_quality(std::size_t n) {
  return n == 4 ? 1 : std::sin(2 * std::numbers::pi_v<float> / static_cast<float>(n));
}

}  // namespace

LocalSearch::LocalSearch(Extraction& extraction, const VertexFaces& around, Placement& placement,
                         const Context& context)
    : mesh_(extraction.mesh),
      around_(around),
      placement_(placement),
      quality_(mesh_.faces.size()),
      normals_(mesh_.positions.size()),
      is_rival_(mesh_.faces.size(), 0),
      batches_(mesh_, around_),
      tried_(mesh_.positions.size(), 0),
      moved_(mesh_.positions.size(), 0) {
  constexpr std::size_t grain = 1024;
  context.for_ranges(normals_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) normals_[v] = placement_.normal(v);
  });
  const double area = sum_over_ranges(
      quality_.size(),
      [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          quality_[f] = quality_here(f);
          sum += area_vector(std::as_const(mesh_.faces)[f], mesh_.positions).norm();
        }
        return sum;
      },
      context);
  mean_area_ = static_cast<float>(area / static_cast<double>(quality_.size()));
}

bool LocalSearch::improve(std::span<const Index> vertices, int sweeps, const Context& context) {
  const auto apart = batches_(vertices);
  bool any = false;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    context.check();
    std::atomic<bool> moved = false;
    for (const std::vector<Index>& batch : apart) {
      ++now_;
      // Rivals look at each other wherever they are, so that then it is one after the other.
      const std::size_t grain = rivals_.empty() ? 8 : batch.size();
      context.for_ranges(batch.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Index v = batch[k];
          if (!has_news(v)) continue;
          tried_[v] = now_;
          if (!improve(v)) continue;
          moved_[v] = now_ + 1;
          moved = true;
        }
      });
      ++now_;
    }
    if (!moved) break;
    any = true;
  }
  return any;
}

void LocalSearch::keep_apart(std::vector<Index> faces) {
  for (const Index f : rivals_) is_rival_[f] = 0;
  rivals_ = std::move(faces);
  for (const Index f : rivals_) is_rival_[f] = 1;
}

Vec3 LocalSearch::mean_neighbor(Index v) const {
  Vec3 sum = Vec3::Zero();
  float count = 0;
  for (const Index f : around_[v]) {
    for (const Index w : std::as_const(mesh_.faces)[f]) {
      if (w == v) continue;
      sum += mesh_.positions[w];
      ++count;
    }
  }
  return sum / count;
}

void LocalSearch::put(std::span<const Index> vertices, std::span<const Place> places) {
  std::vector<Index> faces;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Index v = vertices[k];
    mesh_.positions[v] = places[k].position;
    placement_.set_seed(v, places[k].seed);
    normals_[v] = placement_.normal(v);
    faces.insert(faces.end(), around_[v].begin(), around_[v].end());
  }
  sort_unique(faces);
  for (const Index f : faces) quality_[f] = quality_here(f);
}

/// Whether something has moved around v since it was last tried.
bool LocalSearch::has_news(Index v) const {
  if (tried_[v] == 0) return true;
  for (const Index f : around_[v]) {
    for (const Index w : std::as_const(mesh_.faces)[f]) {
      if (moved_[w] > tried_[v]) return true;
    }
  }
  return false;
}

LocalSearch::Upward LocalSearch::upward(Index f) const {
  // On a crease, and more so at a corner, the normal is a mean of sides that the face is not on.
  Vec3 of_free = Vec3::Zero(), of_lines = Vec3::Zero();
  for (const Index v : std::as_const(mesh_.faces)[f]) {
    (placement_.is_on_line(v) ? of_lines : of_free) += normals_[v];
  }
  const bool mixed = !of_free.isZero() && !of_lines.isZero();
  return {(of_free + of_lines).normalized(), mixed ? of_free.normalized() : Vec3(Vec3::Zero())};
}

float LocalSearch::quality_here(Index f, const Vec3& area, const Upward& upward) const {
  const auto face = std::as_const(mesh_.faces)[f];
  const float q = face_quality(face, mesh_.positions, area, upward.of_all);
  if (q > 0 || upward.of_free.isZero(0)) return q;
  return std::max(q, face_quality(face, mesh_.positions, area, upward.of_free));
}

float LocalSearch::quality_here(Index f) const {
  return quality_here(f, area_vector(std::as_const(mesh_.faces)[f], mesh_.positions), upward(f));
}

float LocalSearch::quality_among_neighbors(Index f) const {
  const auto face = std::as_const(mesh_.faces)[f];
  return face_quality(face, mesh_.positions, area_vector(face, mesh_.positions),
                      area_around(mesh_, f, around_).normalized());
}

float LocalSearch::shape_lack(Index v, std::span<const Upward> upward, float limit) const {
  constexpr float good = 0.75f;               // of what is best
  constexpr float against_cutting_off = 450;  // before the shapes of faces
  float sum = against_cutting_off * static_cast<float>(placement_.cut_off(v));
  for (std::size_t k = 0; k < upward.size() && sum < limit; ++k) {
    const Index f = around_[v][k];
    const auto face = std::as_const(mesh_.faces)[f];
    const Vec3 area = area_vector(face, mesh_.positions);
    const float q = quality_here(f, area, upward[k]);
    const float best = best_quality(face.size());
    const float irregular = std::max(0.0f, best - q);
    const float bad = std::max(0.0f, good * best - q);
    sum += irregular * irregular + 15 * bad * bad;
    const float uneven = std::log(std::max(area.norm() / mean_area_, 1e-3f));
    sum += 0.1f * uneven * uneven;
  }
  return sum;
}

float LocalSearch::lack(Index v, const Star& star, float limit) const {
  float sum = shape_lack(v, star.upward, limit);
  for (const Index f : around_[v]) {
    if (sum < limit) sum += crossing(f, star.near, limit - sum);
  }
  return sum;
}

/// From `limit` on it need not be exact.
float LocalSearch::crossing(Index f, std::span<const Rival> near, float limit) const {
  if (!is_rival_[f]) return 0;
  const Eigen::AlignedBox3f box = face_box(mesh_, f);
  float sum = 0;
  for (const auto& [g, near_box] : near) {
    if (f == g || !box.intersects(near_box ? *near_box : face_box(mesh_, g))) continue;
    const double deep = penetration_of_near(mesh_, f, g);
    if (deep > 0) sum += 1 + 20 * static_cast<float>(deep) / std::sqrt(mean_area_);
    if (sum >= limit) break;
  }
  return sum;
}

std::vector<LocalSearch::Rival> LocalSearch::rivals_near(Index v, float distance) const {
  std::vector<Rival> near;
  if (rivals_.empty()) return near;
  Eigen::AlignedBox3f box;
  for (const Index f : around_[v]) box.extend(face_box(mesh_, f));
  const Eigen::AlignedBox3f wide(box.min().array() - distance, box.max().array() + distance);
  for (const Index g : rivals_) {
    const Eigen::AlignedBox3f near_box = face_box(mesh_, g);
    if (!wide.intersects(near_box)) continue;
    const bool moves = std::ranges::binary_search(around_[v], g);
    near.push_back({g, moves ? std::nullopt : std::optional(near_box)});
  }
  return near;
}

/// In edge lengths. What is nearly good needs no long ones.
float LocalSearch::first_step(Index v) const {
  float worst = 1;
  for (const Index f : around_[v]) worst = std::min(worst, quality_[f]);
  return worst > 0.5f ? 0.125f : worst > 0.2f ? 0.25f : 0.5f;
}

bool LocalSearch::improve(Index v) {
  if (placement_.is_fixed(v) || around_[v].empty()) return false;
  const Vec3 x = any_tangent(normals_[v]), y = normals_[v].cross(x);
  float length = 0;
  for (const Index f : around_[v]) {
    const auto face = std::as_const(mesh_.faces)[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      length += (mesh_.positions[face[k]] - mesh_.positions[face[(k + 1) % face.size()]]).norm() /
                static_cast<float>(face.size() * around_[v].size());
    }
  }
  Star star{{}, rivals_near(v, length)};
  for (const Index f : around_[v]) star.upward.push_back(upward(f));
  const float before = lack(v, star, std::numeric_limits<float>::infinity());
  if (before < 1e-6f) return false;
  Vec3 best = mesh_.positions[v];
  Placement::Seed best_seed = placement_.seed(v);
  float least = before;
  // Most targets are far from being better: that is seen before they are put on the surface.
  constexpr float far = 1.02f;
  const bool is_seen = placement_.is_free(v) && mesh_.faces.size() >= few_faces;
  // Where nothing is good nearby, as between sheets that lie on each other, it may be far away.
  constexpr float farthest = 4;  // sides
  const Vec3 middle = mean_neighbor(v);
  const float reach = std::max(farthest * std::sqrt(mean_area_), (best - middle).norm());
  const auto attempt = [&](const Vec3& target) {
    mesh_.positions[v] = target;
    if (is_seen && shape_lack(v, star.upward, far * least) >= far * least) return;
    placement_.set_seed(v, best_seed);
    mesh_.positions[v] = placement_.place(target, v);
    if ((mesh_.positions[v] - middle).norm() > reach) return;
    const float now = lack(v, star, least);
    if (now < least) {
      least = now;
      best = mesh_.positions[v];
      best_seed = placement_.seed(v);
    }
  };
  attempt(middle);
  for (float step = first_step(v) * length; step > 0.03f * length; step /= 2) {
    const Vec3 from = best;
    for (const auto& [along, across] : directions) {
      attempt(from + step * (along * x + across * y));
    }
  }
  mesh_.positions[v] = best;
  placement_.set_seed(v, best_seed);
  if (least > 0.99f * before) return false;
  put({{v}}, {{{best, best_seed}}});
  return true;
}

}  // namespace meshgrain
