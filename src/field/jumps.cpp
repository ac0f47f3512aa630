#include "field/jumps.h"

#include <algorithm>
#include <array>

#include "field/with_symmetry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/jumps.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "field/symmetry_lanes.h"
#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// Both fields at a node, one a lane.
struct Nodes {
  Vec3s x, n, o, p;
  CellSizes size;

  HWY_INLINE Nodes(const Graph& graph, const OrientationField& orientation,
                   const PositionField& position, const Ints& index)
      : x(gather(graph.positions.data(), index)),
        n(gather(graph.normals.data(), index)),
        o(gather(orientation.directions.data(), index)),
        p(gather(position.points.data(), index)),
        size(cell_sizes(position.edge_length, index)) {}
};

/// Jumps, one a lane; the integers as floats.
struct Jumps {
  Floats rotation;
  Coordinates t;
};

/// The rotation of j's lattice that brings it nearest to that of i: of all pairs of representatives
/// those at the least angle. Both turn only through half a circle, as opposite pairs make the same
/// angle.
template <int S>
HWY_INLINE Floats match_extrinsic(const Nodes& i, const Nodes& j) {
  constexpr int half = S / 2;
  Floats rotation = all(0), best_cosine = all(-1);
  for (int k = 0; k < half; ++k) {
    const Vec3s a = rotate<S>(i.o, i.n, k);
    for (int l = 0; l < half; ++l) {
      const Floats cosine = dot(a, rotate<S>(j.o, j.n, l));
      const Mask better = hn::Gt(hn::Abs(cosine), best_cosine);
      const Floats same = all(static_cast<float>((l + S - k) % S));
      const Floats opposite = all(static_cast<float>((l + half + S - k) % S));
      best_cosine = choose(better, hn::Abs(cosine), best_cosine);
      rotation = choose(better, choose(hn::Lt(cosine, all(0)), opposite, same), rotation);
    }
  }
  return rotation;
}

/// The same with j's unfolded into the plane of i.
template <int S>
HWY_INLINE Floats match_intrinsic(const Nodes& i, const Nodes& j) {
  constexpr int half = S / 2;
  const Vec3s unfolded = transport(j.o, j.n, i.n);
  Floats rotation = all(0), best_cosine = all(-1);
  for (int k = 0; k < half; ++k) {
    const Floats cosine = dot(i.o, rotate<S>(unfolded, i.n, k));
    const Mask better = hn::Gt(hn::Abs(cosine), best_cosine);
    const Floats same = all(static_cast<float>(k)), opposite = all(static_cast<float>(k + half));
    best_cosine = choose(better, hn::Abs(cosine), best_cosine);
    rotation = choose(better, choose(hn::Lt(cosine, all(0)), opposite, same), rotation);
  }
  return rotation;
}

template <int S>
HWY_INLINE Vec3s turned(const Vec3s& o, const Vec3s& n, const Floats& rotation) {
  constexpr int half = S / 2;
  const Mask is_opposite = hn::Ge(rotation, all(half));
  const Floats steps = choose(is_opposite, rotation - all(half), rotation);
  Vec3s result = o;
  for (int k = 1; k < half; ++k) {
    result = choose(hn::Eq(steps, all(static_cast<float>(k))), rotate<S>(o, n, k), result);
  }
  return choose(is_opposite, -result, result);
}

template <int S, PositionEnergy E>
HWY_INLINE Jumps jumps_between(const Nodes& i, const Nodes& j) {
  const Lattices<S> lattice(i.p, i.o, i.n, i.size);
  const Vec3s q = intermediate_positions(i.x, i.n, j.x, j.n);
  if constexpr (E == PositionEnergy::extrinsic) {
    const Floats rotation = match_extrinsic<S>(i, j);
    const Lattices<S> neighbor(j.p, turned<S>(j.o, j.n, rotation), j.n, j.size);
    const LatticePair t = match_lattices(lattice, neighbor, q);
    return {rotation, {t.i[0] - t.j[0], t.i[1] - t.j[1]}};
  } else {
    return {match_intrinsic<S>(i, j), lattice.round(q + transport(j.p - q, j.n, i.n))};
  }
}

/// As many at once as there are lanes.
template <typename Between>
HWY_INLINE void for_edges(const Graph& graph, const OrientationField& orientation,
                          const PositionField& position,
                          std::span<const std::array<Index, 2>> edges, Jump* jumps,
                          const Between& between) {
  const std::size_t width = hn::Lanes(Lanes());
  for (std::size_t first = 0; first < edges.size(); first += width) {
    const std::size_t count = std::min(width, edges.size() - first);
    HWY_ALIGN std::int32_t ends[2][most_lanes];
    for (std::size_t k = 0; k < width; ++k) {  // those too many repeat the first one
      const auto& [i, j] = edges[first + (k < count ? k : 0)];
      ends[0][k] = static_cast<std::int32_t>(i);
      ends[1][k] = static_cast<std::int32_t>(j);
    }
    const Nodes i(graph, orientation, position, hn::Load(IntLanes(), ends[0]));
    const Nodes j(graph, orientation, position, hn::Load(IntLanes(), ends[1]));
    const Jumps found = between(i, j);
    HWY_ALIGN std::int32_t rotation[most_lanes], t[2][most_lanes];
    hn::Store(hn::ConvertTo(IntLanes(), found.rotation), IntLanes(), rotation);
    for (int axis = 0; axis < 2; ++axis) {
      hn::Store(hn::ConvertTo(IntLanes(), found.t[axis]), IntLanes(), t[axis]);
    }
    for (std::size_t k = 0; k < count; ++k) jumps[first + k] = {rotation[k], {t[0][k], t[1][k]}};
  }
}

void find_jumps(const Graph& graph, const OrientationField& orientation,
                const PositionField& position, PositionEnergy energy,
                std::span<const std::array<Index, 2>> edges, Jump* jumps) {
  with_posy(position.posy, [&]<int S>() {
    with_energy(energy, [&]<PositionEnergy E>() {
      for_edges(graph, orientation, position, edges, jumps,
                [](const Nodes& i, const Nodes& j) { return jumps_between<S, E>(i, j); });
    });
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

std::vector<Jump> edge_jumps(const Graph& graph, const OrientationField& orientation,
                             const PositionField& position, PositionEnergy energy,
                             std::span<const std::array<Index, 2>> edges) {
  std::vector<Jump> jumps(edges.size());
  MESHGRAIN_BEST_TARGET(find_jumps)(graph, orientation, position, energy, edges, jumps.data());
  return jumps;
}

Jump edge_jump(const Graph& graph, const OrientationField& orientation,
               const PositionField& position, PositionEnergy energy, Index i, Index j) {
  const std::array<std::array<Index, 2>, 1> edge{{{i, j}}};
  Jump jump;
  MESHGRAIN_BEST_TARGET(find_jumps)(graph, orientation, position, energy, edge, &jump);
  return jump;
}

}  // namespace meshgrain
#endif
