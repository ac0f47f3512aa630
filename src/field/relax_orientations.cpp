#include "field/relax_orientations.h"

#include "field/with_symmetry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/relax_orientations.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "field/symmetry_lanes.h"
#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// Two representatives, turned so that the angle between them is least.
struct Pair {
  Vec3s own, other;
};

template <int N, OrientationEnergy E>
class Relaxation {
 public:
  HWY_INLINE Relaxation(const Graph& graph, const DirectionConstraints& constraints,
                        const Vec3* field, NeighborLanes& around)
      : graph_(graph),
        constraints_(constraints),
        field_(field),
        around_(around),
        n_(gather(graph.normals.data(), around.nodes)) {}

  HWY_INLINE Vec3s run() {
    // The length of the sum does not matter to the choice, so it is normalised once, at the end.
    const Vec3s before = gather(field_, around_.nodes);
    Vec3s sum = before;
    for (bool first = true; around_.next(); first = false) {
      const Pair pair = matched(sum);
      const Vec3s weighted = around_.weights() * pair.other;
      const Vec3s next = first ? weighted : pair.own + weighted;
      sum = choose(around_.active, project_to_plane(next, n_), sum);
    }
    return constrained(normalized_or(sum, before));
  }

 private:
  static constexpr int half = N / 2;

  HWY_INLINE Pair matched(const Vec3s& sum) const {
    const Vec3s o = gather(field_, around_.neighbors);
    const Vec3s n = gather(graph_.normals.data(), around_.neighbors);
    if constexpr (E == OrientationEnergy::intrinsic) {
      return {sum, most_similar<N>(transport(o, n, n_), n_, sum)};
    } else if constexpr (N == 1) {
      return {sum, o};
    } else {
      // Both turn only through half a circle, as opposite pairs make the same angle.
      Pair best{sum, o};
      Floats best_cosine = all(-1);
      for (int k = 0; k < half; ++k) {
        const Vec3s a = rotate<N>(sum, n_, k);
        for (int l = 0; l < half; ++l) {
          const Vec3s b = rotate<N>(o, n, l);
          const Floats cosine = dot(a, b);
          const Mask better = hn::Gt(hn::Abs(cosine), best_cosine);
          best_cosine = choose(better, hn::Abs(cosine), best_cosine);
          best.own = choose(better, a, best.own);
          best.other = choose(better, choose(hn::Lt(cosine, all(0)), -b, b), best.other);
        }
      }
      return best;
    }
  }

  static HWY_INLINE Vec3s normalized_or(const Vec3s& v, const Vec3s& fallback) {
    const Floats length = norm(v);
    return choose(hn::Gt(length, all(1e-6f)), v / length, fallback);
  }

  /// Section 3.7: between the value found and the constraint, in its most similar rotation.
  HWY_INLINE Vec3s constrained(const Vec3s& value) const {
    if (constraints_.strengths.empty()) return value;
    const Floats strength = gather(constraints_.strengths.data(), around_.nodes);
    const Mask wanted = hn::Ne(strength, all(0));
    if (hn::AllFalse(Lanes(), wanted)) return value;
    const Vec3s direction = gather(constraints_.directions.data(), around_.nodes);
    // Normalised twice, as steps with integers held do it: both pull to the same bytes.
    const Vec3s target = normalized_or(project_to_plane(direction, n_), value);
    const Vec3s similar = most_similar<N>(target / norm(target), n_, value);
    const Vec3s mixed = (all(1) - strength) * value + (strength * norm(value)) * similar;
    return choose(wanted, normalized_or(project_to_plane(mixed, n_), similar), value);
  }

  const Graph& graph_;
  const DirectionConstraints& constraints_;
  const Vec3* field_;
  NeighborLanes& around_;
  Vec3s n_;
};

void relax(const Graph& graph, const DirectionConstraints& constraints, int rosy,
           OrientationEnergy energy, std::span<const Index> nodes, const Vec3* field,
           Vec3* values) {
  with_rosy(rosy, [&]<int N>() {
    with_energy(energy, [&]<OrientationEnergy E>() {
      for_lanes(graph, nodes, values, [&](NeighborLanes& around) {
        return Relaxation<N, E>(graph, constraints, field, around).run();
      });
    });
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

void relax_orientations(const Graph& graph, const DirectionConstraints& constraints, int rosy,
                        OrientationEnergy energy, std::span<const Index> nodes, const Vec3* field,
                        Vec3* values) {
  MESHGRAIN_BEST_TARGET(relax)(graph, constraints, rosy, energy, nodes, field, values);
}

}  // namespace meshgrain
#endif
