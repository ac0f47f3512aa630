#include "field/carry_fields.h"

#include "field/rosy.h"
#include "field/with_symmetry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/carry_fields.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "field/symmetry_lanes.h"
#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// Stores what `value` makes of the nodes [begin, end).
template <typename Value>
HWY_INLINE void make_values(Index begin, Index end, Vec3* values, const Value& value) {
  for_range(begin, end, [&](const Ints& nodes, Index first, Index count) {
    store(value(nodes), count, values + first);
  });
}

/// Projected and made unit; any tangent where nothing is left.
HWY_INLINE Vec3s unit_tangents(const Vec3s& v, const Vec3s& n) {
  const Vec3s tangent = project_to_plane(v, n);
  const Floats length = norm(tangent);
  const Mask is_left = hn::And(hn::Gt(length, all(1e-6f) * norm(v)), hn::Ne(length, all(0)));
  const Vec3s unit = tangent / length;
  if (hn::AllTrue(Lanes(), is_left)) return unit;
  return choose(is_left, unit, any_tangent(n));
}

template <int N>
HWY_INLINE Vec3s mean_of_children(const Graph& fine, const Children& children, const Vec3* finer,
                                  const Ints& nodes, const Vec3s& n) {
  Ints entry = gather(children.offsets.data(), nodes);
  const Ints end = gather(children.offsets.data() + 1, nodes);
  Ints child = gather(children.nodes.data(), entry);
  Floats area = gather(fine.areas.data(), child);
  Vec3s mean = unit_tangents(gather(finer, child), n);
  for (;;) {
    const auto more = hn::Lt(entry + hn::Set(IntLanes(), 1), end);
    if (hn::AllFalse(IntLanes(), more)) return mean;
    entry = hn::IfThenElse(more, entry + hn::Set(IntLanes(), 1), entry);
    const Mask active = hn::RebindMask(Lanes(), more);
    child = gather(children.nodes.data(), entry);
    const Floats total = area + gather(fine.areas.data(), child);
    const Floats share = choose(hn::Gt(total, all(0)), area / total, all(0.5f));
    const Vec3s own = unit_tangents(mean, n);
    const Vec3s other = most_similar<N>(unit_tangents(gather(finer, child), n), n, own);
    const Vec3s sum = share * own + (all(1) - share) * other;
    mean = choose(active, unit_tangents(sum, n), mean);
    area = choose(active, total, area);
  }
}

void prolong_orientations(const Graph& graph, const std::vector<Index>& parents, Index begin,
                          Index end, const Vec3* coarser, Vec3* values) {
  make_values(begin, end, values, [&](const Ints& nodes) {
    return unit_tangents(gather(coarser, gather(parents.data(), nodes)),
                         gather(graph.normals.data(), nodes));
  });
}

void restrict_orientations(const Graph& fine, const Graph& coarse, const Children& children,
                           int rosy, Index begin, Index end, const Vec3* finer, Vec3* values) {
  with_rosy(rosy, [&]<int N>() {
    make_values(begin, end, values, [&](const Ints& nodes) {
      return mean_of_children<N>(fine, children, finer, nodes,
                                 gather(coarse.normals.data(), nodes));
    });
  });
}

void prolong_positions(const Graph& graph, const LatticeFrame& frame,
                       const std::vector<Index>& parents, int posy, Index begin, Index end,
                       const Vec3* coarser, Vec3* values) {
  with_posy(posy, [&]<int S>() {
    make_values(begin, end, values, [&](const Ints& nodes) {
      const Vec3s x = gather(graph.positions.data(), nodes);
      const Vec3s n = gather(graph.normals.data(), nodes);
      const Vec3s p = gather(coarser, gather(parents.data(), nodes));
      const Lattices<S> lattice(p - dot(n, p - x) * n, gather(frame.directions.data(), nodes), n,
                                cell_sizes(frame.edge_length, nodes));
      return lattice.point(lattice.round(x));
    });
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

void prolong_orientations(const Graph& graph, const std::vector<Index>& parents, Index begin,
                          Index end, const Vec3* coarser, Vec3* values) {
  MESHGRAIN_BEST_TARGET(prolong_orientations)(graph, parents, begin, end, coarser, values);
}

void restrict_orientations(const Graph& fine, const Graph& coarse, const Children& children,
                           int rosy, Index begin, Index end, const Vec3* finer, Vec3* values) {
  MESHGRAIN_BEST_TARGET(restrict_orientations)
  (fine, coarse, children, rosy, begin, end, finer, values);
}

void prolong_positions(const Graph& graph, const LatticeFrame& frame,
                       const std::vector<Index>& parents, int posy, Index begin, Index end,
                       const Vec3* coarser, Vec3* values) {
  MESHGRAIN_BEST_TARGET(prolong_positions)
  (graph, frame, parents, posy, begin, end, coarser, values);
}

}  // namespace meshgrain
#endif
