#include "field/constraints.h"

#include "field/with_symmetry.h"
#include "meshgrain/error.h"

namespace meshgrain {
namespace {

/// Where a node of the finer level adds to what its parent has already, the first child's part
/// stays as it is: half of nothing must not weaken a constraint, or it would fade from level to
/// level.
template <typename Level, typename Add>
void merge_up(const Hierarchy& hierarchy, std::vector<Level>& levels, const Add& add) {
  for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
    for (Index i = 0; i < hierarchy.parents[l].size(); ++i) {
      if (levels[l].strengths[i] > 0) add(levels[l], i, levels[l + 1], hierarchy.parents[l][i]);
    }
  }
}

void check_node(const Hierarchy& hierarchy, Index node) {
  if (node >= hierarchy.levels[0].size()) {
    throw Error("a constraint names node " + std::to_string(node) + " of a graph of " +
                std::to_string(hierarchy.levels[0].size()));
  }
}

}  // namespace

std::vector<DirectionConstraints> spread_constraints(
    const Hierarchy& hierarchy, int rosy, std::span<const OrientationConstraint> constraints) {
  std::vector<DirectionConstraints> levels(hierarchy.levels.size());
  if (constraints.empty()) return levels;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    levels[l].directions.assign(hierarchy.levels[l].size(), Vec3::Zero());
    levels[l].strengths.assign(hierarchy.levels[l].size(), 0);
  }
  for (const OrientationConstraint& c : constraints) {
    check_node(hierarchy, c.node);
    levels[0].directions[c.node] = c.direction.normalized();
    levels[0].strengths[c.node] = std::clamp(c.strength, 0.0f, 1.0f);
  }
  with_rosy(rosy, [&]<int N>() {
    merge_up(hierarchy, levels,
             [&](const DirectionConstraints& fine, Index i, DirectionConstraints& coarse, Index k) {
               const std::size_t l = static_cast<std::size_t>(&coarse - levels.data());
               const Vec3& n = hierarchy.levels[l].normals[k];
               const Vec3 d = project_to_plane(fine.directions[i], n).normalized();
               if (!(d.squaredNorm() > 0.5f)) return;  // it points along the normal
               if (coarse.strengths[k] == 0) {
                 coarse.directions[k] = d;
                 coarse.strengths[k] = fine.strengths[i];
                 return;
               }
               const float total = coarse.strengths[k] + fine.strengths[i];
               const float share = coarse.strengths[k] / total;
               const Vec3 similar =
                   RoSy<N>::rotate(d, n, RoSy<N>::match_intrinsic(coarse.directions[k], n, d));
               const Vec3 mean = share * coarse.directions[k] + (1 - share) * similar;
               if (mean.norm() > 1e-6f) coarse.directions[k] = mean.normalized();
               coarse.strengths[k] = std::max(coarse.strengths[k], fine.strengths[i]);
             });
  });
  return levels;
}

std::vector<LineConstraints> spread_constraints(const Hierarchy& hierarchy,
                                                std::span<const PositionConstraint> constraints) {
  std::vector<LineConstraints> levels(hierarchy.levels.size());
  if (constraints.empty()) return levels;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    levels[l].points.assign(hierarchy.levels[l].size(), Vec3::Zero());
    levels[l].directions.assign(hierarchy.levels[l].size(), Vec3::Zero());
    levels[l].strengths.assign(hierarchy.levels[l].size(), 0);
  }
  for (const PositionConstraint& c : constraints) {
    check_node(hierarchy, c.node);
    levels[0].points[c.node] = c.point;
    levels[0].directions[c.node] =
        c.direction.isZero() ? Vec3(Vec3::Zero()) : Vec3(c.direction.normalized());
    levels[0].strengths[c.node] = std::clamp(c.strength, 0.0f, 1.0f);
  }
  merge_up(hierarchy, levels,
           [](const LineConstraints& fine, Index i, LineConstraints& coarse, Index k) {
             if (coarse.strengths[k] == 0) {
               coarse.points[k] = fine.points[i];
               coarse.directions[k] = fine.directions[i];
               coarse.strengths[k] = fine.strengths[i];
               return;
             }
             // Two lines that run alike share their mean; a point, or the stronger, wins otherwise.
             const float cosine = coarse.directions[k].dot(fine.directions[i]);
             if (std::fabs(cosine) > 0.5f) {
               const float share = coarse.strengths[k] / (coarse.strengths[k] + fine.strengths[i]);
               coarse.points[k] = share * coarse.points[k] + (1 - share) * fine.points[i];
               const Vec3 similar = cosine < 0 ? Vec3(-fine.directions[i]) : fine.directions[i];
               coarse.directions[k] =
                   (share * coarse.directions[k] + (1 - share) * similar).normalized();
             } else if (fine.directions[i].isZero() || fine.strengths[i] > coarse.strengths[k]) {
               coarse.points[k] = fine.points[i];
               coarse.directions[k] = fine.directions[i];
             }
             coarse.strengths[k] = std::max(coarse.strengths[k], fine.strengths[i]);
           });
  return levels;
}

}  // namespace meshgrain
