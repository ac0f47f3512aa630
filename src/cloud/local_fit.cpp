#include "cloud/local_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace meshgrain {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void LocalFit::look(std::span<const Vec3> points, std::span<const Vec3> normals, Index point,
                    std::span<const Index> neighbors) {
  places_.assign(1, Vector3d::Zero());
  weights_.assign(1, 1);
  if (neighbors.empty()) return;
  const Vector3d p = points[point].cast<double>();
  const double reach = (points[neighbors.back()].cast<double>() - p).squaredNorm();
  for (const Index j : neighbors) {
    if (!normals.empty() && normals[point].dot(normals[j]) < 0) continue;
    const Vector3d place = points[j].cast<double>() - p;
    places_.push_back(place);
    weights_.push_back(std::exp(-3 * place.squaredNorm() / reach));
  }
}

LocalFit::Plane LocalFit::plane() const {
  double total = 0;
  Vector3d mean = Vector3d::Zero();
  Matrix3d squares = Matrix3d::Zero();
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Vector3d& place = places_[k];
    total += weights_[k];
    mean += weights_[k] * place;
    squares += weights_[k] * place * place.transpose();
  }
  const Matrix3d covariance = squares - mean * mean.transpose() / total;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
  return {solver.eigenvectors(), solver.eigenvalues()};
}

Vector3d LocalFit::way_to_surface() const {
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  constexpr double stiff = 1e-3;  // where too few points tell how it bends
  const Matrix3d axes = plane().axes;
  const double scale = places_.back().norm();
  if (!(scale > 0)) return Vector3d::Zero();
  Matrix6d squares = stiff * Matrix6d::Identity();
  squares(0, 0) = 0;
  Vector6d heights = Vector6d::Zero();
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Vector3d q = axes.transpose() * places_[k] / scale;
    const double x = q[1], y = q[2];
    Vector6d terms;
    terms << 1, x, y, x * x, x * y, y * y;
    squares += weights_[k] * terms * terms.transpose();
    heights += weights_[k] * q[0] * terms;
  }
  return axes.col(0) * (squares.ldlt().solve(heights)[0] * scale);
}

}  // namespace meshgrain
