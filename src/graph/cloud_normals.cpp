#include "graph/cloud_normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "graph/nearest_neighbors.h"
#include "graph/orient_normals.h"
#include "meshgrain/normals.h"

namespace meshgrain {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The normal of the plane of least squares through a point's neighbours and itself, of either
/// sign.
Vec3 plane_normal(std::span<const Vec3> points, std::size_t i, std::span<const Index> neighbors) {
  if (neighbors.empty()) return Vec3::UnitZ();
  const Vector3d p = points[i].cast<double>();
  const double reach = (points[neighbors.back()].cast<double>() - p).squaredNorm();
  double weights = 1;
  Vector3d sum = Vector3d::Zero();
  Matrix3d squares = Matrix3d::Zero();
  for (const Index j : neighbors) {
    const Vector3d d = points[j].cast<double>() - p;
    // Falls to a twentieth at the farthest neighbour: follows the curvature about as well as half
    // as many neighbours of equal weight would, and noise still averages out.
    const double w = std::exp(-3 * d.squaredNorm() / reach);
    weights += w;
    sum += w * d;
    squares += w * d * d.transpose();
  }
  const Matrix3d covariance = squares - sum * sum.transpose() / weights;
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance).eigenvectors().col(0).cast<float>();
}

/// Placeholders have no length, and what comes from elsewhere may be no number.
bool is_direction(const Vec3& normal) {
  return std::abs(normal.squaredNorm() - 1) < 0.5f;
}

}  // namespace

std::vector<Vec3> estimate_normals(const Mesh& cloud, std::size_t k, const Context& context) {
  const std::vector<Vec3>& points = cloud.positions;
  const Neighborhoods neighborhoods = nearest_neighbors(points, k, context);
  std::vector<Vec3> normals(points.size());
  context.for_ranges(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (std::size_t i = begin; i < end; ++i)
      normals[i] = plane_normal(points, i, neighborhoods[i]);
  });
  orient_normals(points, neighborhoods, normals, context);
  return normals;
}

std::vector<Vec3> cloud_normals(const Mesh& cloud, std::size_t k, const Context& context) {
  const std::vector<Vec3>& given = cloud.normals;
  if (!given.empty() && std::ranges::all_of(given, is_direction)) return given;
  std::vector<Vec3> normals = estimate_normals(cloud, k, context);
  if (std::ranges::none_of(given, is_direction)) return normals;
  // An estimate has the sign that those given nearby ask for, or else all of them.
  const auto agreement = [&](std::size_t i, std::size_t j) {
    return is_direction(given[j]) ? given[j].dot(normals[i]) : 0.0f;
  };
  double in_all = 0;
  for (std::size_t i = 0; i < given.size(); ++i) in_all += agreement(i, i);
  const Neighborhoods neighborhoods = nearest_neighbors(cloud.positions, k, context);
  context.for_ranges(given.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double nearby = 0;
      for (const Index j : neighborhoods[i]) nearby += agreement(i, j);
      if ((nearby != 0 ? nearby : in_all) < 0) normals[i] = -normals[i];
    }
  });
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (is_direction(given[i])) normals[i] = given[i];
  }
  return normals;
}

}  // namespace meshgrain
