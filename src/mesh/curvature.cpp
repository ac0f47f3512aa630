#include "meshgrain/curvature.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace meshgrain {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Two unit vectors that make a right-handed frame with the normal.
struct Frame {
  Vector3d n, u, v;

  // The construction without a branch of Duff et al. 2017.
  explicit Frame(const Vec3& normal) : n(normal.cast<double>()) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1 / (sign + n.z());
    const double b = n.x() * n.y() * a;
    u = {1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
    v = {b, sign + n.y() * n.y() * a, -n.y()};
  }

  Vector2d tangent(const Vector3d& x) const { return {u.dot(x), v.dot(x)}; }
};

/// The symmetric matrix [a b; b c] of the second fundamental form in a frame's u and v.
using Form = Vector3d;

Form fit(std::size_t i, std::span<const Index> around, std::span<const Vec3> positions,
         std::span<const Vec3> normals) {
  const Frame frame(normals[i]);
  Matrix3d squares = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const Index j : around) {
    const Vector2d e = frame.tangent((positions[j] - positions[i]).cast<double>());
    const Vector2d d = frame.tangent((normals[j] - normals[i]).cast<double>());
    // Both rows of [a b; b c] e = d, divided by the length of e: an edge counts for its direction,
    // not for its length.
    const double length2 = e.squaredNorm();
    if (length2 == 0) continue;
    const Vector3d row1(e.x(), e.y(), 0), row2(0, e.x(), e.y());
    squares += (row1 * row1.transpose() + row2 * row2.transpose()) / length2;
    right += (row1 * d.x() + row2 * d.y()) / length2;
  }
  // Too little to tell all three numbers (edges along one line) leaves the rest near zero.
  squares.diagonal().array() += 1e-6 * squares.trace();
  return squares.trace() > 0 ? Form(squares.ldlt().solve(right)) : Form::Zero();
}

/// The first vector of a frame once its plane is turned into another one about their common line:
/// about itself, if they are opposite.
Vector3d turned(const Frame& from, const Frame& to) {
  constexpr double opposite = 1e-9;
  const double length = 1 + from.n.dot(to.n);
  if (length < opposite) return from.u;
  return from.u - from.u.dot(to.n) / length * (from.n + to.n);
}

/// A neighbour's form as seen in `to`.
Form transport(const Form& form, const Frame& from, const Frame& to) {
  const Vector2d cs = to.tangent(turned(from, to));
  const double c = cs.x(), s = cs.y();
  const double a = form[0], b = form[1], d = form[2];
  return {c * c * a - 2 * c * s * b + s * s * d, c * s * (a - d) + (c * c - s * s) * b,
          s * s * a + 2 * c * s * b + c * c * d};
}

}  // namespace

Curvature estimate_curvature(std::span<const Index> offsets, std::span<const Index> neighbors,
                             std::span<const Vec3> positions, std::span<const Vec3> normals,
                             const Context& context, int smoothing) {
  const std::size_t count = positions.size();
  constexpr std::size_t grain = 2048;
  const auto around = [&](std::size_t i) {
    return neighbors.subspan(offsets[i], offsets[i + 1] - offsets[i]);
  };

  std::vector<Form> forms(count);
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (std::size_t i = begin; i < end; ++i) forms[i] = fit(i, around(i), positions, normals);
  });

  std::vector<Form> next(smoothing > 0 ? count : 0);
  for (int round = 0; round < smoothing; ++round) {
    context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
      context.check();
      for (std::size_t i = begin; i < end; ++i) {
        const Frame frame(normals[i]);
        Form sum = forms[i];
        for (const Index j : around(i)) sum += transport(forms[j], Frame(normals[j]), frame);
        next[i] = sum / static_cast<double>(1 + around(i).size());
      }
    });
    forms.swap(next);
  }

  Curvature result{std::vector<Vec3>(count), std::vector<float>(count), std::vector<float>(count)};
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Frame frame(normals[i]);
      const double a = forms[i][0], b = forms[i][1], c = forms[i][2];
      const double mean = (a + c) / 2, half = std::hypot((a - c) / 2, b);
      // The larger eigenvalue mean + half belongs to this angle, the smaller one to that across it.
      double angle = std::atan2(b, (a - c) / 2) / 2;
      if (mean < 0) angle += std::acos(0.0);
      result.kmax[i] = static_cast<float>(mean < 0 ? mean - half : mean + half);
      result.kmin[i] = static_cast<float>(mean < 0 ? mean + half : mean - half);
      result.direction[i] =
          (std::cos(angle) * frame.u + std::sin(angle) * frame.v).normalized().cast<float>();
    }
  });
  return result;
}

}  // namespace meshgrain
