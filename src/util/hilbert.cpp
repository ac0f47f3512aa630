#include "util/hilbert.h"

#include <algorithm>
#include <array>

#include "util/bounding_box.h"
#include "util/radix_sort.h"

namespace meshgrain {
namespace {

constexpr int bits = 21;  // an axis: 63 of the key's 64 bits
constexpr std::size_t grain = 1 << 14;

/// Bits 0 to 20 of a number at every third place.
std::uint64_t spread_out(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Points whose keys are found side by side, so that the compiler can use SIMD: more than it
/// unrolls.
constexpr std::size_t lanes = 64;
using Lane = std::array<std::uint32_t, lanes>;

/// All bits of a number as one of them is.
std::uint32_t mask(std::uint32_t value, int bit) {
  return 0u - (value >> bit & 1);
}

/// Distances along the curve of cells, by the transpose method of Skilling, "Programming the
/// Hilbert curve" (AIP Conference Proceedings 707, 2004); without branches, as no one could predict
/// them.
void hilbert_keys(Lane& x, Lane& y, Lane& z, std::array<std::uint64_t, lanes>& keys) {
  for (int bit = bits - 1; bit > 0; --bit) {
    const std::uint32_t low = (1u << bit) - 1;
    for (std::size_t k = 0; k < lanes; ++k) x[k] ^= low & mask(x[k], bit);
    const auto fold = [&](Lane& own) {
      for (std::size_t k = 0; k < lanes; ++k) {
        const std::uint32_t first = x[k], is_set = mask(own[k], bit);
        const std::uint32_t swapped = (first ^ own[k]) & low & ~is_set;
        x[k] = first ^ ((low & is_set) | swapped);
        own[k] ^= swapped;
      }
    };
    fold(y);
    fold(z);
  }
  Lane turned;  // each bit the parity of the higher ones of z
  for (std::size_t k = 0; k < lanes; ++k) {
    y[k] ^= x[k];
    z[k] ^= y[k];
    turned[k] = z[k] >> 1;
    for (int step = 1; step < bits; step *= 2) turned[k] ^= turned[k] >> step;
  }
  for (std::size_t k = 0; k < lanes; ++k) {
    keys[k] = spread_out(x[k] ^ turned[k]) << 2 | spread_out(y[k] ^ turned[k]) << 1 |
              spread_out(z[k] ^ turned[k]);
  }
}

/// The key of each point.
std::vector<std::uint64_t> keys_of(std::span<const Vec3> points, const Context& context) {
  const Eigen::AlignedBox3f box = bounding_box(points, context);
  const float side = points.empty() ? 1.0f : std::max(box.sizes().maxCoeff(), 1e-30f);
  const float cells = static_cast<float>((1u << bits) - 1) / side;
  std::vector<std::uint64_t> keys(points.size());
  context.for_ranges(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::array<Lane, 3> cell{};
    std::array<std::uint64_t, lanes> found;
    for (std::size_t i = begin; i < end; i += lanes) {
      const std::size_t count = std::min(lanes, end - i);
      for (std::size_t k = 0; k < count; ++k) {
        const Vec3 place = (points[i + k] - box.min()) * cells;
        for (int axis = 0; axis < 3; ++axis) {
          cell[axis][k] = static_cast<std::uint32_t>(place[axis]);
        }
      }
      hilbert_keys(cell[0], cell[1], cell[2], found);
      std::copy_n(found.begin(), count, keys.begin() + static_cast<std::ptrdiff_t>(i));
    }
  });
  return keys;
}

}  // namespace

std::vector<Index> hilbert_order(std::span<const Vec3> points, const Context& context) {
  const std::vector<std::uint64_t> keys = keys_of(points, context);
  // By the upper half of the key first, with the point's index below it: few share one.
  constexpr int lower = 3 * bits - 32;
  std::vector<std::uint64_t> sorted(points.size());
  context.for_ranges(sorted.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sorted[i] = keys[i] >> lower << 32 | i;
  });
  radix_sort_by_upper(sorted, 32, context);

  std::vector<Index> order(points.size());
  const auto is_run = [&](std::size_t k) { return sorted[k] >> 32 == sorted[k - 1] >> 32; };
  const auto comes_first = [&](Index a, Index b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
  };
  // A range sorts the runs that begin in it.
  context.for_ranges(order.size(), grain, [&](std::size_t begin, std::size_t end) {
    while (begin > 0 && begin < end && is_run(begin)) ++begin;
    for (std::size_t k = begin, first; k < end;) {
      for (first = k++; k < order.size() && is_run(k);) ++k;
      for (std::size_t i = first; i < k; ++i) order[i] = static_cast<Index>(sorted[i]);
      if (k > first + 1) std::sort(&order[first], &order[first] + (k - first), comes_first);
    }
  });
  return order;
}

}  // namespace meshgrain
