#include "measure/surface_sampler.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "util/hash.h"

namespace meshgrain {
namespace {

/// A number in [0, 1) that depends on `i` and `stream`, one of three, alone.
double random_number(std::uint64_t i, std::uint64_t stream) {
  return double(hash64(3 * i + stream) >> 11) * 0x1p-53;
}

}  // namespace

SurfaceSampler::SurfaceSampler(const Mesh& mesh, std::size_t samples)
    : positions_(mesh.positions), triangles_(triangles_of(mesh)), samples_(samples) {
  double sum = 0;
  area_up_to_.reserve(triangles_.size());
  for (const auto& [a, b, c] : triangles_)
    area_up_to_.push_back(sum += (at(b) - at(a)).cross(at(c) - at(a)).norm());
  if (sum > 0) return;
  triangles_.clear();
  samples_ = std::min(samples, positions_.size());
}

Eigen::Vector3d SurfaceSampler::operator[](std::size_t i) const {
  const double position = (double(i) + random_number(i, 0)) / double(samples_);
  if (triangles_.empty()) {
    // Of as many samples as vertices, every vertex is one.
    if (samples_ == positions_.size()) return at(Index(i));
    const double v = position * double(positions_.size());
    return at(std::min(Index(v), Index(positions_.size() - 1)));
  }
  const auto strip =
      std::lower_bound(area_up_to_.begin(), area_up_to_.end(), position * area_up_to_.back());
  const auto t = std::min<std::size_t>(strip - area_up_to_.begin(), triangles_.size() - 1);
  const double u = std::sqrt(random_number(i, 1)), v = random_number(i, 2);
  const auto [a, b, c] = triangles_[t];
  return (1 - u) * at(a) + u * (1 - v) * at(b) + u * v * at(c);
}

}  // namespace meshgrain
