#include "cloud/cloud_normals.h"

#include <algorithm>
#include <cmath>

#include "cloud/local_fit.h"
#include "cloud/nearest_neighbors.h"
#include "cloud/orient_normals.h"
#include "meshgrain/normals.h"

namespace meshgrain {
namespace {

/// Placeholders have no length, and what comes from elsewhere may be no number.
bool is_direction(const Vec3& normal) {
  return std::abs(normal.squaredNorm() - 1) < 0.5f;
}

std::vector<Vec3> estimate_normals(std::span<const Vec3> points, const Neighborhoods& nearest,
                                   const Context& context) {
  std::vector<Vec3> normals(points.size());
  context.for_ranges(normals.size(), 1024, [&](std::size_t begin, std::size_t end) {
    context.check();
    LocalFit fit;
    for (std::size_t i = begin; i < end; ++i) {
      fit.look(points, {}, static_cast<Index>(i), nearest[i]);
      normals[i] = fit.plane().axes.col(0).cast<float>();
    }
  });
  orient_normals(points, nearest, normals, context);
  return normals;
}

}  // namespace

std::vector<Vec3> estimate_normals(const Mesh& cloud, std::size_t k, const Context& context) {
  return estimate_normals(cloud.positions, nearest_neighbors(cloud.positions, k, context), context);
}

std::vector<Vec3> cloud_normals(const Mesh& cloud, const Neighborhoods& nearest,
                                const Context& context) {
  const std::vector<Vec3>& given = cloud.normals;
  if (!given.empty() && std::ranges::all_of(given, is_direction)) return given;
  std::vector<Vec3> normals = estimate_normals(cloud.positions, nearest, context);
  if (std::ranges::none_of(given, is_direction)) return normals;
  // An estimate has the sign that those given nearby ask for, or else all of them.
  const auto agreement = [&](std::size_t i, std::size_t j) {
    return is_direction(given[j]) ? given[j].dot(normals[i]) : 0.0f;
  };
  double in_all = 0;
  for (std::size_t i = 0; i < given.size(); ++i) in_all += agreement(i, i);
  context.for_ranges(given.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double nearby = 0;
      for (const Index j : nearest[i]) nearby += agreement(i, j);
      if ((nearby != 0 ? nearby : in_all) < 0) normals[i] = -normals[i];
    }
  });
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (is_direction(given[i])) normals[i] = given[i];
  }
  return normals;
}

}  // namespace meshgrain
