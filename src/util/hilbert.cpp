#include "util/hilbert.h"

#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <array>
#include <utility>

namespace meshgrain {
namespace {

constexpr int bits = 21;  // an axis: 63 of the key's 64 bits

/// Distance along the curve of a cell, by the transpose method of Skilling, "Programming the
/// Hilbert curve" (AIP Conference Proceedings 707, 2004).
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
    const std::uint32_t low = q - 1;
    for (auto& xi : x) {
      if (xi & q) {
        x[0] ^= low;
      } else {
        const std::uint32_t t = (x[0] ^ xi) & low;
        x[0] ^= t;
        xi ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
    if (x[2] & q) t ^= q - 1;
  }
  std::uint64_t key = 0;
  for (auto& xi : x) xi ^= t;
  for (int b = bits - 1; b >= 0; --b) {
    for (const std::uint32_t xi : x) key = key << 1 | (xi >> b & 1);
  }
  return key;
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
