#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "measure/bvh.h"
#include "meshgrain/error.h"
#include "meshgrain/statistics.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;

/// A number in [0, 1) that depends on `i` and `stream` alone (Steele et al. 2014, SplitMix64).
double random_number(std::uint64_t i, std::uint64_t stream) {
  std::uint64_t x = (3 * i + stream + 1) * 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return double((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

/// Points all over a surface: one in every strip of an equal share of the area.
class SurfaceSampler {
 public:
  SurfaceSampler(const Mesh& mesh, std::size_t samples)
      : positions_(mesh.positions), triangles_(triangles_of(mesh)), samples_(samples) {
    double sum = 0;
    area_up_to_.reserve(triangles_.size());
    for (const auto& [a, b, c] : triangles_)
      area_up_to_.push_back(sum += (at(b) - at(a)).cross(at(c) - at(a)).norm());
    if (sum > 0) return;
    // A cloud, or a surface without area: its vertices, if need be only so many.
    triangles_.clear();
    samples_ = std::min(samples, positions_.size());
  }

  std::size_t size() const { return samples_; }

  Point operator[](std::size_t i) const {
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

 private:
  Point at(Index v) const { return positions_[v].cast<double>(); }

  const std::vector<Vec3>& positions_;
  std::vector<Triangle> triangles_;
  std::vector<double> area_up_to_;
  std::size_t samples_;
};

}  // namespace

SurfaceDistance surface_distance(const Mesh& from, const Mesh& to, double reference_length,
                                 std::size_t samples, const Context& context) {
  if (!(reference_length > 0))
    throw Error("the reference length of a distance must be positive (is the input one point?)");
  if (from.positions.empty() || to.positions.empty())
    throw Error("an empty mesh has no distance to another");
  if (samples == 0) throw Error("a distance needs at least one sample");
  const SurfaceSampler sampler(from, samples);
  const Bvh tree(to);
  const Point shift = from.origin - to.origin;
  std::vector<double> distance(sampler.size());
  context.for_ranges(sampler.size(), 1024, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (std::size_t i = begin; i < end; ++i)
      distance[i] = std::sqrt(tree.closest(sampler[i] + shift).squared_distance);
  });
  SurfaceDistance result;
  for (double d : distance) {
    result.mean += d / double(distance.size());
    result.max = std::max(result.max, d);
  }
  result.mean /= reference_length;
  result.max /= reference_length;
  return result;
}

}  // namespace meshgrain
