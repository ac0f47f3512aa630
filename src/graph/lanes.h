// Vectors of several nodes at once, one a SIMD lane. Compiled anew for every instruction set:
// include it after hwy/foreach_target.h only.

#if defined(MESHGRAIN_GRAPH_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHGRAIN_GRAPH_LANES_H
#undef MESHGRAIN_GRAPH_LANES_H
#else
#define MESHGRAIN_GRAPH_LANES_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "meshgrain/graph.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t most_lanes = 16;
using Lanes = hn::CappedTag<float, most_lanes>;
using IntLanes = hn::RebindToSigned<Lanes>;
using Floats = hn::Vec<Lanes>;
using Ints = hn::Vec<IntLanes>;
using Mask = hn::Mask<Lanes>;

HWY_INLINE Floats all(float x) {
  return hn::Set(Lanes(), x);
}

/// A vector a lane. Sums go from the right, as Eigen's do: a lane gets the bytes that scalar code
/// would.
struct Vec3s {
  Floats x, y, z;
};

HWY_INLINE Vec3s operator+(const Vec3s& a, const Vec3s& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Vec3s operator-(const Vec3s& a, const Vec3s& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Vec3s operator*(const Floats& s, const Vec3s& a) {
  return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE Vec3s operator/(const Vec3s& a, const Floats& s) {
  return {a.x / s, a.y / s, a.z / s};
}
HWY_INLINE Vec3s operator-(const Vec3s& a) {
  return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}
HWY_INLINE Floats dot(const Vec3s& a, const Vec3s& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}
HWY_INLINE Vec3s cross(const Vec3s& a, const Vec3s& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE Floats norm(const Vec3s& a) {
  return hn::Sqrt(dot(a, a));
}
HWY_INLINE Floats choose(const Mask& mask, const Floats& yes, const Floats& no) {
  return hn::IfThenElse(mask, yes, no);
}
HWY_INLINE Vec3s choose(const Mask& mask, const Vec3s& yes, const Vec3s& no) {
  return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
}
HWY_INLINE Vec3s project_to_plane(const Vec3s& v, const Vec3s& normal) {
  return v - dot(normal, v) * normal;
}

/// transport() of field/rosy.h.
HWY_INLINE Vec3s transport(const Vec3s& tangent, const Vec3s& from, const Vec3s& to) {
  const Floats cosine = dot(from, to);
  const Vec3s moved = tangent - (dot(to, tangent) / (all(1) + cosine)) * (from + to);
  return choose(hn::Lt(cosine, all(-0.9999f)), tangent, moved);
}

HWY_INLINE Floats gather(const float* values, const Ints& index) {
  return hn::GatherIndex(Lanes(), values, index);
}
HWY_INLINE Ints gather(const Index* values, const Ints& index) {
  return hn::GatherIndex(IntLanes(), reinterpret_cast<const std::int32_t*>(values), index);
}
HWY_INLINE Vec3s gather(const Vec3* values, const Ints& index) {
  const float* first = values->data();
  const Ints at = index + (index + index);
  return {gather(first, at), gather(first + 1, at), gather(first + 2, at)};
}

/// any_tangent() of field/rosy.h.
HWY_INLINE Vec3s any_tangent(const Vec3s& n) {
  const Floats sign = hn::CopySign(all(1), n.z);
  const Floats a = all(-1) / (sign + n.z);
  return {all(1) + sign * n.x * n.x * a, sign * n.x * n.y * a, hn::Neg(sign) * n.x};
}

HWY_INLINE void store(const Vec3s& vectors, std::size_t count, Vec3* values) {
  if (count == hn::Lanes(Lanes())) {
    hn::StoreInterleaved3(vectors.x, vectors.y, vectors.z, Lanes(), values->data());
    return;
  }
  HWY_ALIGN float x[most_lanes], y[most_lanes], z[most_lanes];
  hn::Store(vectors.x, Lanes(), x);
  hn::Store(vectors.y, Lanes(), y);
  hn::Store(vectors.z, Lanes(), z);
  for (std::size_t k = 0; k < count; ++k) values[k] = {x[k], y[k], z[k]};
}

/// Nodes of a graph, one a lane, at their neighbours, one after the other.
class NeighborLanes {
 public:
  /// Up to as many nodes as there are lanes; others repeat the first one.
  NeighborLanes(const Graph& graph, const Index* first, std::size_t count)
      : NeighborLanes(graph, load(first, count)) {}

  NeighborLanes(const Graph& graph, const Ints& indices)
      : nodes(indices),
        graph_(graph),
        entry_(gather(graph.offsets.data(), nodes)),
        end_(gather(graph.offsets.data() + 1, nodes)) {}

  /// Goes on to the next neighbour; returns false when no node has any more.
  HWY_INLINE bool next() {
    const auto more = hn::Lt(entry_, end_);
    if (hn::AllFalse(IntLanes(), more)) return false;
    active = hn::RebindMask(Lanes(), more);
    entries = hn::IfThenElseZero(more, entry_);
    neighbors = hn::IfThenElse(more, gather(graph_.neighbors.data(), entries), nodes);
    entry_ = hn::IfThenElse(more, entry_ + hn::Set(IntLanes(), 1), entry_);
    return true;
  }

  HWY_INLINE Floats weights() const {
    return graph_.weights.empty() ? all(1) : gather(graph_.weights.data(), entries);
  }

  Ints nodes;
  Ints entries;
  Ints neighbors;  // of lanes that have no more, the node itself
  Mask active;     // lanes that have a neighbour

 private:
  static HWY_INLINE Ints load(const Index* first, std::size_t count) {
    HWY_ALIGN std::int32_t index[most_lanes];
    for (std::size_t k = 0; k < hn::Lanes(IntLanes()); ++k) {
      index[k] = static_cast<std::int32_t>(first[k < count ? k : 0]);
    }
    return hn::Load(IntLanes(), index);
  }

  const Graph& graph_;
  Ints entry_, end_;
};

/// Calls `body(nodes, first, count)` for the nodes [begin, end), `count` at once from `first` on;
/// lanes too many repeat the last one.
template <typename Body>
HWY_INLINE void for_range(Index begin, Index end, const Body& body) {
  const auto width = static_cast<Index>(hn::Lanes(Lanes()));
  for (Index first = begin; first < end; first += width) {
    const Ints nodes = hn::Min(hn::Iota(IntLanes(), static_cast<std::int32_t>(first)),
                               hn::Set(IntLanes(), static_cast<std::int32_t>(end - 1)));
    body(nodes, first, std::min(width, end - first));
  }
}

/// `values` gets what `step` makes of each of the nodes, as many at once as there are lanes.
template <typename Step>
HWY_INLINE void for_lanes(const Graph& graph, std::span<const Index> nodes, Vec3* values,
                          const Step& step) {
  const std::size_t width = hn::Lanes(Lanes());
  for (std::size_t k = 0; k < nodes.size(); k += width) {
    const std::size_t count = std::min(width, nodes.size() - k);
    NeighborLanes around(graph, nodes.data() + k, count);
    store(step(around), count, values + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#endif
