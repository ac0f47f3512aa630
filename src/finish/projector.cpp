#include "finish/projector.h"

#include <hwy/cache_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "measure/face_shape.h"
#include "util/triangle.h"

namespace meshgrain {

Vec3 Projector::nearest_around(const Vec3& p, Index vertex, Index& nearest_corner) const {
  Vec3 best = surface_.positions[vertex];
  float best_distance = (p - best).squaredNorm();
  nearest_corner = vertex;
  for (const Index f : around_[vertex]) {
    const auto face = surface_.faces[f];
    const Vec3 q = closest_point_on_triangle<Vec3>(
        p, surface_.positions[face[0]], surface_.positions[face[1]], surface_.positions[face[2]]);
    const float distance = (p - q).squaredNorm();
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = q;
    nearest_corner = face[0];
    for (const Index v : face) {
      if ((surface_.positions[v] - q).squaredNorm() <
          (surface_.positions[nearest_corner] - q).squaredNorm()) {
        nearest_corner = v;
      }
    }
  }
  return best;
}

Vec3 Projector::normal(Index vertex) const {
  if (surface_.is_point_cloud()) return graph_.normals[vertex];
  Vec3 sum = Vec3::Zero();
  for (const Index f : around_[vertex]) sum += area_vector(surface_.faces[f], surface_.positions);
  const float length = sum.norm();
  return length > 0 ? Vec3(sum / length) : Vec3(Vec3::Zero());
}

std::optional<std::vector<Index>> Projector::faces_in(const Eigen::AlignedBox3f& box,
                                                      std::vector<Index> from,
                                                      std::size_t most) const {
  std::unordered_set<Index> seen(from.begin(), from.end()), faces;
  while (!from.empty()) {
    if (faces.size() > most) return std::nullopt;
    const Index v = from.back();
    from.pop_back();
    for (const Index f : around_[v]) {
      faces.insert(f);
      for (const Index w : surface_.faces[f]) {
        if (box.contains(surface_.positions[w]) && seen.insert(w).second) from.push_back(w);
      }
    }
  }
  std::vector<Index> found(faces.begin(), faces.end());
  std::sort(found.begin(), found.end());
  return found;
}

Vec3 Projector::project(const Vec3& p, Index& seed) const {
  if (surface_.is_point_cloud()) return project_on_cloud(p, seed);
  Index corner = seed;
  Vec3 best = nearest_around(p, seed, corner);
  while (corner != seed) {
    Index next = corner;
    const Vec3 q = nearest_around(p, corner, next);
    if ((p - q).squaredNorm() > (p - best).squaredNorm()) break;
    const bool nearer = (p - q).squaredNorm() < (p - best).squaredNorm();
    seed = corner;
    best = q;
    if (!nearer) break;
    corner = next;
  }
  return best;
}

Projector::Plane Projector::touch(const Vec3& p, Index& seed) const {
  if (surface_.is_point_cloud() || graph_.size() != surface_.positions.size()) {
    const Vec3 point = project(p, seed);
    return {point, normal(seed)};
  }
  walk_to_nearest(p, seed);
  return {graph_.positions[seed], graph_.normals[seed]};
}

void Projector::prefetch_node(Index seed) const {
  if (seed >= graph_.size()) return;
  hwy::Prefetch(&graph_.offsets[seed]);
  hwy::Prefetch(&graph_.positions[seed]);
  hwy::Prefetch(&graph_.normals[seed]);
}

void Projector::prefetch_neighbors(Index seed) const {
  if (seed < graph_.size()) hwy::Prefetch(graph_.neighbors.data() + graph_.offsets[seed]);
}

void Projector::walk_to_nearest(const Vec3& p, Index& seed) const {
  float best = (graph_.positions[seed] - p).squaredNorm();
  for (Index from = no_index; from != seed;) {
    from = seed;
    for (const Index j : graph_.neighbors_of(from)) {
      const float distance = (graph_.positions[j] - p).squaredNorm();
      if (distance < best) {
        best = distance;
        seed = j;
      }
    }
  }
}

Vec3 Projector::project_on_cloud(const Vec3& p, Index& seed) const {
  walk_to_nearest(p, seed);
  // The tangent planes around, nearer ones counting more: smoother than the points themselves.
  float scale = 1e-30f;
  for (const Index j : graph_.neighbors_of(seed)) {
    scale = std::max(scale, (graph_.positions[j] - graph_.positions[seed]).squaredNorm());
  }
  Vec3 normal = Vec3::Zero(), center = Vec3::Zero();
  float total = 0;
  const auto add = [&](Index j) {
    const float w = std::exp(-3 * (graph_.positions[j] - p).squaredNorm() / scale);
    normal += w * graph_.normals[j];
    center += w * graph_.positions[j];
    total += w;
  };
  add(seed);
  for (const Index j : graph_.neighbors_of(seed)) add(j);
  const float length = normal.norm();
  if (!(total > 1e-20f) || !(length > 1e-6f * total)) return graph_.positions[seed];
  normal /= length;
  return p - normal * normal.dot(p - center / total);
}

}  // namespace meshgrain
