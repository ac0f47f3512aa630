#include "field/orientation_kernel.h"

#include <gtest/gtest.h>

#include "made_graph.h"
#include "reference.h"
#include "relaxed.h"

namespace meshgrain {
namespace {

using reference::V;
using reference::v;

template <int N, OrientationEnergy E>
struct Case {
  static constexpr int rosy = N;
  static constexpr OrientationEnergy energy = E;
};
constexpr auto extrinsic = OrientationEnergy::extrinsic, intrinsic = OrientationEnergy::intrinsic,
               convex = OrientationEnergy::convex;

template <typename T>
class OrientationKernelTest : public testing::Test {
 protected:
  static constexpr int N = T::rosy;
  static constexpr OrientationEnergy E = T::energy;
  using Kernel = OrientationKernel<N, E>;

  Graph graph = made::noisy_graph();
  DirectionConstraints none;
  std::vector<Vec3> field = random_field();

  std::vector<Vec3> random_field() const {
    const Kernel kernel(graph, none);
    std::vector<Vec3> values(graph.size());
    for (Index i = 0; i < graph.size(); ++i) values[i] = kernel.random(i, 77 + i);
    return values;
  }

  /// The two sides of an edge, turned to match.
  struct Matched {
    V i, j;
    double margin;
  };
  static Matched match(const V& oi, const V& ni, const V& oj, const V& nj) {
    if (E == extrinsic) {
      const reference::Match m = reference::match_extrinsic(N, oi, ni, oj, nj);
      return {reference::rotate(N, oi, ni, m.i), reference::rotate(N, oj, nj, m.j), m.margin};
    }
    const V oji = reference::unfold(oj, nj, ni);
    const reference::Match m = reference::match_intrinsic(N, oi, ni, oji);
    return {oi, reference::rotate(N, oji, ni, m.j), m.margin};
  }

  struct Relaxed {
    V value;
    double margin = 10;  // of the least certain choice
  };

  /// Eq. 3, with the choice against the normalised vector after each edge.
  Relaxed eq3(Index i) const {
    const V ni = v(graph.normals[i]);
    Relaxed result{v(field[i])};
    V sum = V::Zero();
    for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
      const Index j = graph.neighbors[e];
      const V nj = v(graph.normals[j]);
      const Matched m = match(result.value, ni, v(field[j]), nj);
      const double w = graph.weight(e);
      sum = e == graph.offsets[i] ? V(w * m.j) : V(sum.norm() * m.i + w * m.j);
      sum -= ni * ni.dot(sum);
      result.margin = std::min({result.margin, m.margin, sum.norm()});
      result.value = sum.normalized();
    }
    return result;
  }

  /// The mean of the neighbours as complex numbers to the power of N, with the mean length.
  V knoppel(Index i) const {
    const V n = v(graph.normals[i]), u = v(any_tangent(graph.normals[i])), w = n.cross(u);
    double x = 0, y = 0, total = 0;
    for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
      const Index j = graph.neighbors[e];
      const V oji = reference::unfold(v(field[j]), v(graph.normals[j]), n);
      const double angle = N * std::atan2(oji.dot(w), oji.dot(u));
      x += graph.weight(e) * oji.norm() * std::cos(angle);
      y += graph.weight(e) * oji.norm() * std::sin(angle);
      total += graph.weight(e);
    }
    const double angle = std::atan2(y, x) / N;
    return std::hypot(x, y) / total * (std::cos(angle) * u + std::sin(angle) * w);
  }
};

using Cases =
    testing::Types<Case<1, extrinsic>, Case<2, extrinsic>, Case<4, extrinsic>, Case<6, extrinsic>,
                   Case<1, intrinsic>, Case<2, intrinsic>, Case<4, intrinsic>, Case<6, intrinsic>,
                   Case<1, convex>, Case<2, convex>, Case<4, convex>, Case<6, convex>>;
TYPED_TEST_SUITE(OrientationKernelTest, Cases);

TYPED_TEST(OrientationKernelTest, RelaxesByThePapersLocalIteration) {
  constexpr int rosy = TestFixture::N;
  const typename TestFixture::Kernel kernel(this->graph, this->none);
  std::size_t uncertain = 0;
  // Also after some sweeps, when the field is smooth.
  for (int round = 0; round < 3; ++round) {
    for (Index i = 0; i < this->graph.size(); ++i) {
      const Vec3 got = made::relaxed(kernel, i, this->field.data());
      if constexpr (TestFixture::E == convex) {
        const V expected = this->knoppel(i);
        ASSERT_NEAR(got.norm(), expected.norm(), 1e-4);
        if (expected.norm() < 1e-2) {
          ++uncertain;  // a mean of nearly nothing has no direction
        } else {
          ASSERT_LT(reference::angle_modulo(rosy, v(got), expected, v(this->graph.normals[i])),
                    2e-3);
        }
      } else {
        const auto expected = this->eq3(i);
        if (expected.margin < 1e-3) {
          ++uncertain;  // two choices as good as each other
        } else {
          ASSERT_NEAR(got.norm(), 1, 1e-5);
          ASSERT_LT(
              reference::angle_modulo(rosy, v(got), expected.value, v(this->graph.normals[i])),
              2e-3)
              << "node " << i << " round " << round;
        }
      }
      if (round > 0) this->field[i] = got;
    }
  }
  EXPECT_LT(uncertain, 3 * this->graph.size() / 5);
}

/// Eq. 2 and Eq. 4; for the convex choice, whose lengths are free, the angles of Eq. 2.
TYPED_TEST(OrientationKernelTest, MeasuresThePapersEnergy) {
  const typename TestFixture::Kernel kernel(this->graph, this->none);
  for (const bool smooth : {false, true}) {
    double got = 0, expected = 0;
    for (Index i = 0; i < this->graph.size(); ++i) {
      got += kernel.energy(i, this->field.data());
      for (Index e = this->graph.offsets[i]; e < this->graph.offsets[i + 1]; ++e) {
        const Index j = this->graph.neighbors[e];
        const auto m = TestFixture::match(v(this->field[i]), v(this->graph.normals[i]),
                                          v(this->field[j]), v(this->graph.normals[j]));
        const double angle = reference::angle(m.i, m.j);
        expected += this->graph.weight(e) * angle * angle;
      }
    }
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(got, expected, 1e-4 * expected) << "smooth " << smooth;
    for (int sweep = 0; sweep < 4; ++sweep) {
      for (Index i = 0; i < this->graph.size(); ++i) {
        this->field[i] = made::relaxed(kernel, i, this->field.data());
      }
    }
  }
}

/// Section 3.7: from the value found (strength 0) to the constraint (1), linearly, between the two
/// most similar directions.
TYPED_TEST(OrientationKernelTest, ConstraintsInterpolate) {
  constexpr int rosy = TestFixture::N;
  const typename TestFixture::Kernel free(this->graph, this->none);
  const std::size_t n = this->graph.size();
  for (const float strength : {0.0f, 0.25f, 0.5f, 1.0f}) {
    DirectionConstraints constraints{{}, std::vector<float>(n, strength)};
    // Not quite tangent: the projection counts.
    for (Index i = 0; i < n; ++i) {
      constraints.directions.push_back(
          (free.random(i, 999 + i) + 0.3f * this->graph.normals[i]).normalized());
    }
    const typename TestFixture::Kernel kernel(this->graph, constraints);
    for (Index i = 0; i < n; ++i) {
      const V normal = v(this->graph.normals[i]);
      const V start = v(made::relaxed(free, i, this->field.data()));
      V target = v(constraints.directions[i]);
      target = (target - normal * normal.dot(target)).normalized();
      const reference::Match m = reference::match_intrinsic(rosy, start, normal, target);
      if (m.margin < 1e-3 || start.norm() < 1e-3) continue;
      const V similar = reference::rotate(rosy, target, normal, m.j);
      const V expected = (1 - strength) * start + strength * start.norm() * similar;
      if (expected.norm() < 0.1 * start.norm()) continue;  // opposite: no direction between them
      const V got = v(made::relaxed(kernel, i, this->field.data()));
      ASSERT_LT(reference::angle(got, expected), 2e-3) << "strength " << strength;
      if (strength == 0) {
        ASSERT_EQ(got, start);
      }
      if (strength == 1) {
        ASSERT_LT(reference::angle_modulo(rosy, got, target, normal), 2e-3);
      }
    }
  }
}

TYPED_TEST(OrientationKernelTest, ValuesStayTangent) {
  const typename TestFixture::Kernel kernel(this->graph, this->none);
  for (Index i = 0; i < this->graph.size(); ++i) {
    const Vec3& n = this->graph.normals[i];
    EXPECT_NEAR(kernel.random(i, i).norm(), 1, 1e-5);
    for (const Vec3& value :
         {kernel.random(i, i), made::relaxed(kernel, i, this->field.data()),
          kernel.prolong(i, Vec3(1, 2, 3).normalized()), kernel.prolong(i, n)}) {
      ASSERT_NEAR(value.dot(n), 0, 1e-5);
      ASSERT_TRUE(value.allFinite());
    }
  }
}

TYPED_TEST(OrientationKernelTest, IsolatedNodesKeepTheirValue) {
  Graph one;
  one.positions = {Vec3::Zero()};
  one.normals = {Vec3::UnitZ()};
  one.areas = {1};
  one.offsets = {0, 0};
  const typename TestFixture::Kernel kernel(one, this->none);
  const Vec3 value = Vec3::UnitX();
  EXPECT_EQ(made::relaxed(kernel, 0, &value), value);
  EXPECT_EQ(kernel.energy(0, &value), 0);
}

}  // namespace
}  // namespace meshgrain
