#include "mesh/find_rings.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>

#include "mesh/next_corners.h"
#include "mesh/vertex_ring.h"

// Compiled once for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/find_rings.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t most = VertexRing::most;
using Few = std::array<std::uint32_t, most>;

/// For each of `values`, the bits of the first `count` of `others` that are equal to it.
HWY_INLINE Few find_equal(const Few& values, const Few& others, std::size_t count) {
  const hn::CappedTag<std::uint32_t, most> lanes;
  Few result;
  for (std::size_t begin = 0; begin < most; begin += hn::Lanes(lanes)) {
    const auto own = hn::LoadU(lanes, values.data() + begin);
    auto bits = hn::Zero(lanes), bit = hn::Set(lanes, 1);
    for (std::size_t k = 0; k < count; ++k) {
      const auto is_equal = hn::VecFromMask(lanes, hn::Eq(own, hn::Set(lanes, others[k])));
      bits = hn::Or(bits, hn::And(is_equal, bit));
      bit = hn::Add(bit, bit);
    }
    hn::StoreU(bits, lanes, result.data() + begin);
  }
  return result;
}

/// The triangles around a vertex: who comes after it in each, and the bits of those where that one
/// comes before it.
struct Fan {
  std::size_t count;
  Few next{}, partners{};

  Fan(const Index* corners, std::span<const Index> faces, Index v) : count(faces.size()) {
    Few last{};
    for (std::size_t k = 0; k < count; ++k) {
      const auto [after, before] = next_corners(corners + std::size_t{3} * faces[k], v);
      next[k] = after;
      last[k] = before;
    }
    partners = find_equal(next, last, count);
  }

  /// Whether every neighbour comes after v in one triangle, and before it in one other.
  bool is_ring(Index v) const {
    std::uint32_t met = 0;
    bool is_ring = true;
    for (std::size_t k = 0; k < count; ++k) {
      is_ring &= (partners[k] & (partners[k] - 1)) == 0 && next[k] != v;
      met |= partners[k];
    }
    return is_ring && met == (1U << count) - 1;
  }
};

/// Sharp edges from v, of a ring, to larger indices.
HWY_INLINE void add_sharp(const Fan& fan, std::span<const Index> faces, Index v,
                          SharpSearch& sharp) {
  const auto partner = [&](std::size_t k) {
    return faces[static_cast<std::size_t>(std::countr_zero(fan.partners[k]))];
  };
  std::uint32_t candidates = 0;
  for (std::size_t k = 0; k < fan.count; ++k) {
    const bool is_sharp = sharp.cosine(faces[k], partner(k)) < sharp.flattest;
    candidates |= std::uint32_t{is_sharp && fan.next[k] > v} << k;
  }
  const std::size_t known = sharp.found.size();
  for (; candidates != 0; candidates &= candidates - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(candidates));
    sharp.look_at({v, fan.next[k]}, faces[k], partner(k));
  }
  std::sort(sharp.found.begin() + static_cast<std::ptrdiff_t>(known), sharp.found.end(),
            [](const SharpEdge& a, const SharpEdge& b) { return a.ends < b.ends; });
}

void find_in_range(const Index* corners, const VertexFaces& around, std::size_t begin,
                   std::span<std::uint8_t> is_ring, SharpSearch* sharp) {
  for (std::size_t k = 0; k < is_ring.size(); ++k) {
    const auto v = static_cast<Index>(begin + k);
    const std::span<const Index> faces = around[v];
    is_ring[k] = false;
    if (faces.size() > most) continue;
    const Fan fan(corners, faces, v);
    is_ring[k] = fan.is_ring(v);
    if (is_ring[k] && sharp != nullptr) add_sharp(fan, faces, v, *sharp);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

void find_rings(const Mesh& triangles, const VertexFaces& around, std::size_t begin,
                std::span<std::uint8_t> is_ring, SharpSearch* sharp) {
  const Index* const corners = triangles.faces.corners().data();
  MESHGRAIN_BEST_TARGET(find_in_range)(corners, around, begin, is_ring, sharp);
}

}  // namespace meshgrain
#endif
