#include "finish/regular_polygon.h"

#include <array>
#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "finish/regular_polygon.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "graph/lanes.h"
#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// As many faces as there are lanes, all with n corners; those beyond `count` repeat the first one.
class FaceLanes {
 public:
  HWY_INLINE FaceLanes(const Faces& faces, const Index* which, std::size_t count)
      : corners_(faces.corners().data()), degree_(faces.degree(which[0])) {
    HWY_ALIGN std::int32_t index[most_lanes];
    for (std::size_t k = 0; k < hn::Lanes(IntLanes()); ++k) {
      index[k] = static_cast<std::int32_t>(faces.first(which[k < count ? k : 0]));
    }
    first_ = hn::Load(IntLanes(), index);
  }

  std::size_t degree() const { return degree_; }
  HWY_INLINE Ints corner(std::size_t k) const {
    return gather(corners_, first_ + hn::Set(IntLanes(), static_cast<std::int32_t>(k)));
  }

 private:
  const Index* corners_;
  std::size_t degree_;
  Ints first_;
};

HWY_INLINE Vec3s normalized(const Vec3s& v) {
  const Floats length = norm(v);
  return choose(hn::Gt(length, all(0)), all(1) / length, all(0)) * v;
}

/// The unit normals of faces with these area vectors; zero if there is nothing to tell them from.
HWY_INLINE Vec3s upright(const Vec3s& area, const Vec3s& upward) {
  const Floats along = dot(area, upward);
  const Mask stands =
      hn::And(hn::Gt(along, all(0)),
              hn::Ge(along * along, all(0.04f) * dot(area, area) * dot(upward, upward)));
  return normalized(choose(stands, area, upward));
}

/// The corners of a polygon at a distance of 1 from zero, the first along x.
using Turns = std::span<const std::array<float, 2>>;

struct Fitted {
  Vec3s center, x, y;
  Mask folded;
};

HWY_INLINE Fitted fit(const FaceLanes& faces, const Vec3* positions, const Vec3* normals,
                      const PolygonFit& wanted, Turns turns, float side_of_unit) {
  const std::size_t n = faces.degree();
  Vec3s upward{all(0), all(0), all(0)};
  Floats relative = all(0);
  const bool uniform = wanted.relative_size.uniform();
  for (std::size_t k = 0; k < n; ++k) {
    const Ints v = faces.corner(k);
    upward = upward + gather(normals, v);
    if (!uniform) relative = relative + gather(wanted.relative_size.values.data(), v);
  }
  const Floats count = all(static_cast<float>(n));
  relative = uniform ? all(wanted.relative_size[0]) : relative / count;

  // The coefficient is the mean of the corners, each turned back by the angle of the polygon's.
  const Vec3s start = gather(positions, faces.corner(0));
  const Vec3s zero = start - start;
  Vec3s before = gather(positions, faces.corner(n - 1)), here = start;
  Vec3s center = zero, along = zero, across = zero, area = zero;
  Mask convex = hn::Eq(all(0), all(0));
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3s next = k + 1 < n ? gather(positions, faces.corner(k + 1)) : start;
    const Vec3s ahead = next - here;
    const Vec3s from_start = here - start;
    convex = hn::And(convex, hn::Gt(dot(cross(ahead, before - here), upward), all(0)));
    center = center + from_start;
    along = along + all(turns[k][0]) * from_start;
    across = across + all(turns[k][1]) * from_start;
    area = area + cross(from_start, ahead);
    before = here;
    here = next;
  }
  const Vec3s normal = upright(area, upward);
  Vec3s x = project_to_plane((along - cross(normal, across)) / count, normal);
  const Floats size = norm(x), evenness = all(wanted.evenness);
  const Floats wanted_size = all(wanted.side / side_of_unit) * relative;
  const Floats scale = all(1) - evenness + evenness * wanted_size / size;
  // Nothing is known of faces without a normal.
  const Mask known = hn::And(hn::Gt(size, all(0)), hn::Gt(dot(normal, normal), all(0)));
  x = choose(known, scale, all(0)) * x;
  return {start + center / count, x, cross(normal, x), hn::Not(convex)};
}

void fit_all(const Mesh& mesh, std::span<const Index> which, const std::vector<Vec3>& normals,
             const PolygonFit& wanted, Turns turns, std::vector<Vec3>& places,
             std::vector<Index>& folded) {
  const std::size_t width = hn::Lanes(Lanes());
  const float side_of_unit = std::hypot(turns[1][0] - turns[0][0], turns[1][1] - turns[0][1]);
  for (std::size_t begin = 0; begin < which.size(); begin += width) {
    const std::size_t count = std::min(width, which.size() - begin);
    const Index* some = which.data() + begin;
    const FaceLanes faces(mesh.faces, some, count);
    const Fitted fitted =
        fit(faces, mesh.positions.data(), normals.data(), wanted, turns, side_of_unit);
    for (std::size_t k = 0; k < turns.size(); ++k) {
      const Vec3s place =
          fitted.center + (all(turns[k][0]) * fitted.x + all(turns[k][1]) * fitted.y);
      Vec3 corners[most_lanes];
      store(place, count, corners);
      for (std::size_t i = 0; i < count; ++i) places[mesh.faces.first(some[i]) + k] = corners[i];
    }
    if (hn::AllFalse(Lanes(), fitted.folded)) continue;
    HWY_ALIGN float flags[most_lanes];
    hn::Store(choose(fitted.folded, all(1), all(0)), Lanes(), flags);
    for (std::size_t i = 0; i < count; ++i) {
      if (flags[i] > 0) folded.push_back(some[i]);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

void fit_regular_polygons(const Mesh& mesh, std::span<const Index> which,
                          const std::vector<Vec3>& normals, const PolygonFit& fit,
                          std::vector<Vec3>& places, std::vector<Index>& folded) {
  if (which.empty()) return;
  const std::size_t n = mesh.faces.degree(which[0]);
  std::vector<std::array<float, 2>> turns(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    turns[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  MESHGRAIN_BEST_TARGET(fit_all)(mesh, which, normals, fit, turns, places, folded);
}

}  // namespace meshgrain
#endif
