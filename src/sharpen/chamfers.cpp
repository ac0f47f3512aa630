#include "sharpen/chamfers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "meshgrain/surface.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 512;

constexpr double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

}  // namespace

bool meet_in_crease(const Plane& a, const Plane& b) {
  static const double least = std::cos(radians(30));
  return a.normal.dot(b.normal) < least;
}

Chamfers::Chamfers(const Mesh& triangles, int edges, const Context& context)
    : mesh_(triangles),
      context_(context),
      around_(vertex_faces(triangles, context)),
      edge_(edge_lengths(triangles, context).mean),
      normals_(triangles.positions.size()),
      part_of_(triangles.positions.size(), no_index) {
  find_smooth();
  leave_out_small();
  straighten_normals();
  for (int k = 0; k < edges; ++k) spread();
}

/// Of each vertex, from those of all as they are.
template <typename Change>
void Chamfers::change_parts(const Change& change) {
  std::vector<Index> parts(part_of_.size());
  context_.for_ranges(parts.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) parts[v] = change(v);
  });
  part_of_ = std::move(parts);
}

/// Where the normals of the faces around a vertex differ little, in the mean over their area: those
/// of slivers, of which marching cubes make many, may look anywhere.
void Chamfers::find_smooth() {
  constexpr double most = radians(7) * radians(7);  // in the mean square
  change_parts([&](Index v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double area = 0;
    for (const Index f : around_[v]) {
      const Eigen::Vector3d normal = normal_and_area(f);
      sum += normal;
      area += normal.norm();
    }
    const Eigen::Vector3d mean = sum.normalized();
    normals_[v] = mean.cast<float>();
    return 2 * (area - sum.dot(mean)) < most * area ? v : no_index;
  });
}

/// A vertex in the middle of a chamfer can be smooth, but hardly any other near to it.
void Chamfers::leave_out_small() {
  constexpr int least = 2 * 3;  // each_beside() counts them twice
  static const auto about_the_same = static_cast<float>(std::cos(radians(15)));
  change_parts([&](Index v) {
    if (!is_smooth(v)) return no_index;
    int others = 0;
    each_beside(v, [&](Index w) {
      others += is_smooth(w) && normals_[w].dot(normals_[v]) > about_the_same;
    });
    return others >= least ? v : no_index;
  });
}

/// Without the faces of chamfers, which may have tilted them a little.
void Chamfers::straighten_normals() {
  std::vector<Vec3> normals(normals_.size());
  context_.for_ranges(normals.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      normals[v] = normals_[v];
      if (!is_smooth(v)) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Index f : around_[v]) {
        const auto smooth = [&](Index w) { return is_smooth(w); };
        if (std::ranges::all_of(mesh_.faces[f], smooth)) sum += normal_and_area(f);
      }
      if (!sum.isZero(0)) normals[v] = sum.normalized().cast<float>();
    }
  });
  normals_ = std::move(normals);
}

/// From vertices that have a part to those beside them: so all that are of a part are connected.
/// What another part reached first changes over to one that is nearer.
void Chamfers::spread() {
  constexpr double of_the_way = 0.3;
  change_parts([&](Index v) {
    if (is_smooth(v)) return v;
    std::vector<Index> parts;
    if (has_part(v)) parts.push_back(part_of_[v]);
    each_beside(v, [&](Index w) {
      if (has_part(w)) parts.push_back(part_of_[w]);
    });
    sort_unique(parts);
    Index best = no_index;
    double least = std::numeric_limits<double>::infinity();
    for (const Index part : parts) {
      const Plane near = plane(part);
      const double height = near.height(position(v));
      const double cost = std::abs(height) + of_the_way * (position(v) - near.point).norm() +
                          depth_behind(parts, near, position(v) - height * near.normal);
      if (cost >= least) continue;
      least = cost;
      best = part;
    }
    return best;
  });
}

/// How far a point of one part lies behind others that rise from it, where it cannot be seen.
double Chamfers::depth_behind(std::span<const Index> parts, const Plane& own,
                              const Eigen::Vector3d& point) const {
  double most = 0;
  for (const Index part : parts) {
    const Plane other = plane(part);
    const bool rises = own.height(other.point) > 0 && meshgrain::meet_in_crease(own, other);
    if (rises) most = std::max(most, -other.height(point));
  }
  return most;
}

}  // namespace meshgrain
