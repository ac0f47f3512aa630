#include "mesh/vertex_measures.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/next_corners.h"
#include "mesh/vertex_normals.h"
#include "util/angle.h"

// Compiled once for each instruction set, for loops that the compiler turns into SIMD itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/vertex_measures.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "util/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace meshgrain {
namespace HWY_NAMESPACE {
namespace {

/// Corners of triangles that are measured side by side, so that the compiler can use SIMD.
constexpr std::size_t lanes = 64;
template <typename Number>
using Lane = std::array<Number, lanes>;

template <typename Number>
struct Vector {
  Number x, y, z;

  Vector operator-(const Vector& o) const { return {x - o.x, y - o.y, z - o.z}; }
  template <typename Other>
  explicit operator Vector<Other>() const {
    return {static_cast<Other>(x), static_cast<Other>(y), static_cast<Other>(z)};
  }
};

template <typename Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}

template <typename Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename Number>
Number norm(const Vector<Number>& a) {
  return std::sqrt(dot(a, a));
}

/// What triangles give to a vertex at one of their corners.
class Corners {
 public:
  bool are_full() const { return count_ == lanes; }

  void add(Index v, const Index* face, const Vec3* positions) {
    const auto [after, before] = next_corners(face, v);
    vertices_[count_] = v;
    const Index around[] = {v, after, before};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = positions[around[c]];
      for (std::size_t axis = 0; axis < 3; ++axis) points_[c][axis][count_] = p[axis];
    }
    ++count_;
  }

  /// Calls `give(v, angle, normal, area)` for each, in order, and forgets them.
  template <typename Give>
  void measure(const Give& give) {
    for (std::size_t k = 0; k < lanes; ++k) find_normal(k);
    for (std::size_t k = 0; k < lanes; ++k) areas_[k] = voronoi_share(at(0, k), at(1, k), at(2, k));
    for (std::size_t k = 0; k < count_; ++k) {
      const Vec3 normal(normal_[0][k], normal_[1][k], normal_[2][k]);
      give(vertices_[k], angles_[k], normal, areas_[k]);
    }
    count_ = 0;
  }

 private:
  Vector<float> at(std::size_t c, std::size_t k) const {
    return {points_[c][0][k], points_[c][1][k], points_[c][2][k]};
  }

  /// The triangle's normal, and the angle. What is thinner than the rounding of its coordinates has
  /// no normal.
  void find_normal(std::size_t k) {
    const auto a = Vector<double>(at(0, k)), b = Vector<double>(at(1, k)),
               c = Vector<double>(at(2, k));
    const Vector<double> ab = b - a, ac = c - a, bc = c - b, area = cross(ab, ac);
    const double sine = norm(area);
    double scale = 0;
    for (const auto& point : points_) {
      for (const auto& axis : point) scale = std::max(scale, std::abs(double{axis[k]}));
    }
    const double rounding = 2 * std::numeric_limits<float>::epsilon() * scale;
    const double longest = std::sqrt(std::max(std::max(dot(ab, ab), dot(ac, ac)), dot(bc, bc)));
    const bool is_clear = sine > rounding * longest;
    const double length = is_clear ? sine : 1.0;
    const float kept = is_clear ? 1.0f : 0.0f;
    normal_[0][k] = kept * static_cast<float>(area.x / length);
    normal_[1][k] = kept * static_cast<float>(area.y / length);
    normal_[2][k] = kept * static_cast<float>(area.z / length);
    angles_[k] = quick_angle(sine, dot(ab, ac));
  }

  /// The part of a triangle's area that belongs to its corner `a`: that of its Voronoi cell, cut to
  /// the triangle where that is obtuse.
  static float voronoi_share(const Vector<float>& a, const Vector<float>& b,
                             const Vector<float>& c) {
    const Vector<float> ab = b - a, ac = c - a, ba = a - b, bc = c - b, ca = a - c, cb = b - c;
    const float at_a = dot(ab, ac), at_b = dot(ba, bc), at_c = dot(ca, cb);
    const auto cotangent = [](float cosine, float sine) {
      const bool is_thin = !(sine > 0);
      return is_thin ? 0.0f : cosine / (is_thin ? 1.0f : sine);
    };
    const float area = 0.5f * norm(cross(ab, ac));
    const float of_cell = (dot(ab, ab) * cotangent(at_c, norm(cross(ca, cb))) +
                           dot(ac, ac) * cotangent(at_b, norm(cross(bc, ba)))) /
                          8;
    const float acute = (at_b < 0) | (at_c < 0) ? area / 4 : of_cell;
    return at_a < 0 ? area / 2 : acute;
  }

  std::size_t count_ = 0;
  std::array<Index, lanes> vertices_{};
  std::array<std::array<Lane<float>, 3>, 3> points_{};  // this corner, and the next two; by axis
  std::array<Lane<float>, 3> normal_{};
  Lane<double> angles_{};
  Lane<float> areas_{};
};

/// Of the vertices from `begin` to `end`; normals stay zero where they must be found otherwise.
void measure_range(const Mesh& mesh, const VertexFaces& around, std::size_t begin, std::size_t end,
                   VertexMeasures& result) {
  constexpr double least_sum = 1e-4;  // less, where faces lie back to back, is mostly rounding
  const Index* const faces = mesh.faces.corners().data();
  std::vector<Eigen::Vector3d> sums(end - begin, Eigen::Vector3d::Zero());
  const auto give = [&](Index v, double angle, const Vec3& normal, float area) {
    sums[v - begin] += angle * normal.cast<double>();
    result.areas[v] += area;
  };
  Corners corners;
  for (auto v = static_cast<Index>(begin); v < end; ++v) {
    for (const Index f : around[v]) {
      corners.add(v, faces + std::size_t{3} * f, mesh.positions.data());
      if (corners.are_full()) corners.measure(give);
    }
  }
  corners.measure(give);
  for (std::size_t v = begin; v < end; ++v) {
    const double length = sums[v - begin].norm();
    if (length > least_sum) result.normals[v] = (sums[v - begin] / length).cast<float>();
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain {

VertexMeasures measure_vertices(const Mesh& mesh, const VertexFaces& around,
                                const Context& context) {
  const std::size_t count = mesh.positions.size();
  VertexMeasures result{std::vector<Vec3>(count, Vec3::Zero()), std::vector<float>(count, 0)};
  context.for_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
    context.check();
    MESHGRAIN_BEST_TARGET(measure_range)(mesh, around, begin, end, result);
  });
  complete_normals(mesh, around, result.normals, context);
  return result;
}

}  // namespace meshgrain
#endif
