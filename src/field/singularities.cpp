#include "meshgrain/singularities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "field/jumps.h"
#include "field/rosy.h"
#include "field/with_symmetry.h"
#include "util/collect.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/singularities.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "field/symmetry_lanes.h"
#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// Appends the triangles of [begin, end) around which some angle is so large that they might have
/// an index: few, found without any angle.
template <int N>
void find_suspects(std::span<const Index> corners, const Vec3* normals, const Vec3* directions,
                   Index begin, Index end, std::vector<Index>& suspects) {
  // Three turns and the holonomy, of a fifth of half a step each, make less than half a step.
  constexpr double most = std::numbers::pi / N / 5;
  const Floats least_cosine = all(static_cast<float>(std::cos(most)));
  const Floats most_tangent = all(static_cast<float>(std::tan(most / 2)));
  for_range(begin, end, [&](const Ints& faces, Index first, Index count) {
    std::array<Vec3s, 3> n, o;
    for (std::size_t k = 0; k < 3; ++k) {
      const Ints v = gather(corners.data() + k, faces + (faces + faces));
      n[k] = gather(normals, v);
      o[k] = gather(directions, v);
    }
    const Floats triple = dot(n[0], cross(n[1], n[2]));  // as in holonomy()
    const Floats sum = all(1) + dot(n[0], n[1]) + dot(n[1], n[2]) + dot(n[2], n[0]);
    Mask is_regular = hn::Lt(hn::Abs(triple), most_tangent * sum);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const Vec3s nearest = most_similar<N>(transport(o[next], n[next], n[k]), n[k], o[k]);
      is_regular = hn::And(is_regular, hn::Gt(dot(o[k], nearest), least_cosine));
    }
    if (hn::AllTrue(Lanes(), is_regular)) return;
    HWY_ALIGN float regular[most_lanes];
    hn::Store(choose(is_regular, all(1), all(0)), Lanes(), regular);
    for (Index k = 0; k < count; ++k) {
      if (regular[k] == 0) suspects.push_back(first + k);
    }
  });
}

void suspects(std::span<const Index> corners, const std::vector<Vec3>& normals,
              const OrientationField& field, Index begin, Index end, std::vector<Index>& result) {
  with_rosy(field.rosy, [&]<int N>() {
    find_suspects<N>(corners, normals.data(), field.directions.data(), begin, end, result);
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {
namespace {

constexpr double pi = std::numbers::pi;

/// The angle about `n` from one tangent vector to another.
double angle_between(const Vec3& from, const Vec3& to, const Vec3& n) {
  return std::atan2(static_cast<double>(n.dot(from.cross(to))), static_cast<double>(from.dot(to)));
}

/// How far a vector turns when it is transported around a triangle: the solid angle of the normals.
double holonomy(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double triple = a.dot(b.cross(c));
  const double sum = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
  return 2 * std::atan2(triple, sum);
}

/// From the field at i to that at j by the nearest representative: between -pi / N and pi / N.
double turn(const std::vector<Vec3>& normals, const OrientationField& field, Index i, Index j) {
  const double step = 2 * pi / field.rosy;
  // Measured from the lower index, so that the two directions of an edge cancel exactly.
  const Index low = std::min(i, j), high = std::max(i, j);
  const Vec3 moved = transport(field.directions[high], normals[high], normals[low]);
  const double raw = angle_between(field.directions[low], moved, normals[low]);
  const double nearest = raw - step * std::round(raw / step);
  return i == low ? nearest : -nearest;
}

}  // namespace

std::vector<OrientationSingularity> orientation_singularities(const Mesh& triangles,
                                                              const std::vector<Vec3>& normals,
                                                              const OrientationField& field,
                                                              const Context& context) {
  using Singularity = OrientationSingularity;
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Singularity>& out) {
    std::vector<Index> faces;
    MESHGRAIN_BEST_TARGET(suspects)
    (triangles.faces.corners(), normals, field, static_cast<Index>(begin), static_cast<Index>(end),
     faces);
    for (const Index f : faces) {
      const auto v = triangles.faces[f];
      double total = holonomy(normals[v[0]], normals[v[1]], normals[v[2]]);
      for (std::size_t k = 0; k < 3; ++k) total += turn(normals, field, v[k], v[(k + 1) % 3]);
      const auto index = static_cast<int>(std::lround(total * field.rosy / (2 * pi)));
      if (index != 0) out.push_back({f, index});
    }
  };
  return collect<Singularity>(triangles.faces.size(), look, context);
}

std::vector<PositionSingularity> position_singularities(const Mesh& triangles, const Graph& graph,
                                                        const OrientationField& orientation,
                                                        const PositionField& position,
                                                        PositionEnergy energy,
                                                        const Context& context) {
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<PositionSingularity>& out) {
    std::vector<std::array<Index, 2>> sides;
    for (std::size_t f = begin; f < end; ++f) {
      const auto v = triangles.faces[f];
      for (std::size_t k = 0; k < 3; ++k) sides.push_back({v[k], v[(k + 1) % 3]});
    }
    const std::vector<Jump> jumps = edge_jumps(graph, orientation, position, energy, sides);
    for (std::size_t f = begin; f < end; ++f) {
      const Jump* around = &jumps[3 * (f - begin)];
      const Jump sum =
          composed(composed(around[0], around[1], position.posy), around[2], position.posy);
      if (sum.rotation == 0 && !sum.is_zero()) out.push_back({static_cast<Index>(f), sum.t});
    }
  };
  return collect<PositionSingularity>(triangles.faces.size(), look, context);
}

}  // namespace meshgrain
#endif
