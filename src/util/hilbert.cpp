#include "util/hilbert.h"

#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <array>
#include <utility>

namespace meshgrain {
namespace {

constexpr int bits = 21;  // an axis: 63 of the key's 64 bits

/// Bits 0 to 20 of a number at every third place.
std::uint64_t spread_out(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Distance along the curve of a cell, by the transpose method of Skilling, "Programming the
/// Hilbert curve" (AIP Conference Proceedings 707, 2004); without branches, as no one could predict
/// them.
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  const auto mask = [](std::uint32_t value, int bit) { return 0u - (value >> bit & 1); };
  for (int bit = bits - 1; bit > 0; --bit) {
    const std::uint32_t low = (1u << bit) - 1;
    for (auto& xi : x) {
      const std::uint32_t is_set = mask(xi, bit);
      const std::uint32_t swapped = (x[0] ^ xi) & low & ~is_set;
      x[0] ^= (low & is_set) | swapped;
      xi ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (int bit = bits - 1; bit > 0; --bit) t ^= ((1u << bit) - 1) & mask(x[2], bit);
  for (auto& xi : x) xi ^= t;
  return spread_out(x[0]) << 2 | spread_out(x[1]) << 1 | spread_out(x[2]);
}

}  // namespace

std::vector<Index> hilbert_order(std::span<const Vec3> points, const Context& context) {
  Eigen::AlignedBox3f box;
  for (const Vec3& p : points) box.extend(p);
  const float side = points.empty() ? 1.0f : std::max(box.sizes().maxCoeff(), 1e-30f);
  const float cells = static_cast<float>((1u << bits) - 1) / side;

  std::vector<std::pair<std::uint64_t, Index>> keys(points.size());
  context.for_ranges(points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 cell = (points[i] - box.min()) * cells;
      keys[i] = {
          hilbert_key({static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                       static_cast<std::uint32_t>(cell.z())}),
          static_cast<Index>(i)};
    }
  });
  context.run([&] { tbb::parallel_sort(keys); });

  std::vector<Index> order(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = keys[k].second;
  return order;
}

}  // namespace meshgrain
