#include "cloud/smooth_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cloud/local_fit.h"
#include "cloud/spacing.h"

namespace meshgrain {
namespace {

/// How thick neighbourhoods are beside their width, in the median over some.
float roughness(const Mesh& cloud, const Neighborhoods& nearest, const Context& context) {
  constexpr std::size_t enough = 1 << 14;
  constexpr double least_variance = 1e-300;
  const std::size_t step = 1 + cloud.positions.size() / enough;
  std::vector<float> found((cloud.positions.size() + step - 1) / step);
  context.for_ranges(found.size(), 1024, [&](std::size_t begin, std::size_t end) {
    LocalFit fit;
    for (std::size_t k = begin; k < end; ++k) {
      fit.look(cloud.positions, cloud.normals, static_cast<Index>(k * step), nearest[k * step]);
      const Eigen::Vector3d variances = fit.plane().variances;
      found[k] = static_cast<float>(
          std::sqrt(std::max(variances[0], 0.0) / std::max(variances[1], least_variance)));
    }
  });
  return median(found);
}

void move_onto_surface(Mesh& cloud, const Neighborhoods& nearest, const Context& context) {
  std::vector<Vec3> places = cloud.positions;
  context.for_ranges(places.size(), 1024, [&](std::size_t begin, std::size_t end) {
    context.check();
    LocalFit fit;
    for (std::size_t i = begin; i < end; ++i) {
      fit.look(cloud.positions, cloud.normals, static_cast<Index>(i), nearest[i]);
      places[i] += fit.way_to_surface().cast<float>();
    }
  });
  cloud.positions = std::move(places);
}

}  // namespace

bool smooth_noise(Mesh& cloud, Neighborhoods& nearest, const Context& context) {
  // Without noise, points as far apart as fingers are wide come to 0.25.
  constexpr float rough = 0.3f;
  constexpr int most_times = 3;
  constexpr std::size_t widest = 8;  // times as many neighbours
  const std::size_t k = nearest.k;
  int times = 0;
  for (; times < most_times && roughness(cloud, nearest, context) > rough; ++times) {
    Neighborhoods wider = nearest_neighbors(cloud.positions, 2 * k, context);
    while (wider.k < widest * k && roughness(cloud, wider, context) > rough) {
      wider = nearest_neighbors(cloud.positions, 2 * wider.k, context);
    }
    move_onto_surface(cloud, wider, context);
    nearest = nearest_neighbors(cloud.positions, k, context);
  }
  return times > 0;
}

}  // namespace meshgrain
