#include "mesh/vertex_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "mesh/vertex_normals.h"
#include "util/angle.h"

namespace meshgrain {
namespace {

/// Triangles that are measured side by side, so that the compiler can use SIMD.
constexpr std::size_t lanes = 64;
using Lane = std::array<float, lanes>;

/// Some triangles, and what each gives to its corners.
class Batch {
 public:
  bool is_full() const { return count_ == lanes; }

  void add(std::span<const Index, 3> face, const Vec3* positions) {
    for (std::size_t c = 0; c < 3; ++c) {
      corners_[count_][c] = face[c];
      const Vec3& p = positions[face[c]];
      for (std::size_t axis = 0; axis < 3; ++axis) points_[c][axis][count_] = p[axis];
    }
    ++count_;
  }

  /// Calls `give(v, angle, normal, area)` for each corner, and forgets the triangles.
  template <typename Give>
  void measure(const Give& give) {
    for (std::size_t k = 0; k < lanes; ++k) measure_one(k);
    for (std::size_t k = 0; k < count_; ++k) {
      const Vec3 normal(normal_[0][k], normal_[1][k], normal_[2][k]);
      for (std::size_t c = 0; c < 3; ++c) {
        give(corners_[k][c], angles_[c][k], normal, areas_[c][k]);
      }
    }
    count_ = 0;
  }

 private:
  /// In single precision: the rounding of the positions themselves turns the normal as much.
  void measure_one(std::size_t k) {
    const auto& [a, b, c] = points_;
    const float abx = b[0][k] - a[0][k], aby = b[1][k] - a[1][k], abz = b[2][k] - a[2][k];
    const float acx = c[0][k] - a[0][k], acy = c[1][k] - a[1][k], acz = c[2][k] - a[2][k];
    const float bcx = c[0][k] - b[0][k], bcy = c[1][k] - b[1][k], bcz = c[2][k] - b[2][k];
    const float x = aby * acz - abz * acy, y = abz * acx - abx * acz, z = abx * acy - aby * acx;
    const float ab2 = abx * abx + aby * aby + abz * abz, ac2 = acx * acx + acy * acy + acz * acz,
                bc2 = bcx * bcx + bcy * bcy + bcz * bcz;
    // The cosines at the corners, times the sides there; and so the sine, which is twice the area.
    const float at_a = abx * acx + aby * acy + abz * acz,
                at_b = -(abx * bcx + aby * bcy + abz * bcz),
                at_c = acx * bcx + acy * bcy + acz * bcz;
    const float sine2 = x * x + y * y + z * z, sine = std::sqrt(sine2);
    const float inverse = 1 / std::max(sine, std::numeric_limits<float>::min());

    // What is thinner than the rounding of its coordinates has no normal.
    float scale = 0;
    for (const auto& point : points_) {
      for (const Lane& axis : point) scale = std::max(scale, std::abs(axis[k]));
    }
    const float rounding = 2 * std::numeric_limits<float>::epsilon() * scale;
    const float longest2 = std::max(std::max(ab2, ac2), bc2);
    const float length = sine2 > rounding * rounding * longest2 ? inverse : 0.0f;
    normal_[0][k] = length * x;
    normal_[1][k] = length * y;
    normal_[2][k] = length * z;
    angles_[0][k] = quick_angle(sine, at_a);
    angles_[1][k] = quick_angle(sine, at_b);
    angles_[2][k] = quick_angle(sine, at_c);

    // An eighth of each side's square times the cotangent opposite goes to both of its ends.
    const float of_ab = ab2 * at_c * inverse / 8, of_ac = ac2 * at_b * inverse / 8,
                of_bc = bc2 * at_a * inverse / 8;
    const float area = sine / 2;
    const bool is_obtuse = std::min(std::min(at_a, at_b), at_c) < 0;
    areas_[0][k] = is_obtuse ? (at_a < 0 ? area / 2 : area / 4) : of_ab + of_ac;
    areas_[1][k] = is_obtuse ? (at_b < 0 ? area / 2 : area / 4) : of_ab + of_bc;
    areas_[2][k] = is_obtuse ? (at_c < 0 ? area / 2 : area / 4) : of_ac + of_bc;
  }

  std::size_t count_ = 0;
  std::array<std::array<Index, 3>, lanes> corners_{};
  std::array<std::array<Lane, 3>, 3> points_{};  // of each corner, by axis
  std::array<Lane, 3> normal_{}, angles_{}, areas_{};
};

}  // namespace

VertexMeasures measure_vertices(const Mesh& mesh, const VertexFaces& around,
                                const Context& context) {
  constexpr std::size_t grain = 4096;
  const std::size_t count = mesh.positions.size();
  VertexMeasures result{std::vector<Vec3>(count, Vec3::Zero()), std::vector<float>(count, 0)};
  const Index* const corners = mesh.faces.corners().data();
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<Index>(begin), size = static_cast<Index>(end - begin);
    const auto give = [&](Index v, float angle, const Vec3& normal, float area) {
      if (v - first >= size) return;
      result.normals[v] += angle * normal;
      result.areas[v] += area;
    };
    Batch batch;
    // A triangle gives to all of its corners in the range when the lowest of these has its turn.
    for (Index v = 0; v < size; ++v) {
      for (const Index f : around[begin + v]) {
        const std::span<const Index, 3> face(corners + std::size_t{3} * f, 3);
        // Those before the range wrap around.
        const Index lowest = std::min({face[0] - first, face[1] - first, face[2] - first});
        if (v != lowest) continue;
        batch.add(face, mesh.positions.data());
        if (batch.is_full()) batch.measure(give);
      }
    }
    batch.measure(give);
  });
  finish_normals(mesh, around, result.normals, context);
  return result;
}

}  // namespace meshgrain
