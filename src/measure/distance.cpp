#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "measure/bvh.h"
#include "measure/surface_sampler.h"
#include "meshgrain/error.h"
#include "meshgrain/statistics.h"

namespace meshgrain {
SurfaceDistance surface_distance(const Mesh& from, const Mesh& to, double reference_length,
                                 std::size_t samples, const Context& context) {
  if (!(reference_length > 0))
    throw Error("the reference length of a distance must be positive (is the input one point?)");
  if (from.positions.empty() || to.positions.empty())
    throw Error("an empty mesh has no distance to another");
  if (samples == 0) throw Error("a distance needs at least one sample");
  const SurfaceSampler sampler(from, samples);
  const Bvh tree(to);
  const Eigen::Vector3d shift = from.origin - to.origin;
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
