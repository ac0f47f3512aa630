#include "field/rosy.h"

#include <gtest/gtest.h>

#include <random>

#include "reference.h"

namespace meshgrain {
namespace {

using reference::V;
using reference::v;

/// Two neighbours' normals and representatives.
struct Sample {
  Vec3 ni, oi, nj, oj;
};

class Samples {
 public:
  Vec3 unit() {
    Vec3 x;
    do {
      x = Vec3(normal_(random_), normal_(random_), normal_(random_));
    } while (x.norm() < 1e-3f);
    return x.normalized();
  }
  Vec3 tangent(const Vec3& n) {
    Vec3 x;
    do {
      x = project_to_plane(unit(), n);
    } while (x.norm() < 0.1f);
    return project_to_plane(x.normalized(), n).normalized();
  }
  Vec3 near(const Vec3& n, float amount) { return (n + amount * unit()).normalized(); }

  /// In turn: any two normals, near, equal, nearly equal, opposite and nearly opposite ones; and
  /// equal representatives.
  Sample next() {
    Sample s;
    s.ni = unit();
    switch (count_++ % 8) {
      case 0:
        s.nj = unit();
        break;
      case 1:
        s.nj = near(s.ni, 0.3f);
        break;
      case 2:
        s.nj = s.ni;
        break;
      case 3:
        s.nj = near(s.ni, 1e-4f);
        break;
      case 4:
        s.nj = -s.ni;
        break;
      case 5:
        s.nj = near(-s.ni, 1e-3f);
        break;
      case 6:
        s.nj = near(-s.ni, 0.2f);
        break;
      default:
        s.nj = near(s.ni, 1);
        break;
    }
    s.oi = tangent(s.ni);
    s.oj = tangent(s.nj);
    if (count_ % 5 == 0) {
      s.oj = project_to_plane(s.oi, s.nj);
      if (s.oj.norm() < 0.1f) s.oj = tangent(s.nj);
      s.oj.normalize();
    }
    return s;
  }

 private:
  std::mt19937 random_{1};
  std::normal_distribution<float> normal_;
  int count_ = 0;
};

constexpr int cases = 4000;

template <typename T>
class RoSyTest : public testing::Test {};
template <int N>
using Symmetry = std::integral_constant<int, N>;
using Symmetries = testing::Types<Symmetry<1>, Symmetry<2>, Symmetry<4>, Symmetry<6>>;
TYPED_TEST_SUITE(RoSyTest, Symmetries);

TYPED_TEST(RoSyTest, RotatesAsTheMatrixDoes) {
  constexpr int N = TypeParam::value;
  Samples samples;
  for (int c = 0; c < cases; ++c) {
    const Sample s = samples.next();
    for (int k = 0; k < N; ++k) {
      const V expected = reference::rotate(N, v(s.oi), v(s.ni), k);
      ASSERT_LT((v(RoSy<N>::rotate(s.oi, s.ni, k)) - expected).norm(), 1e-6) << k;
    }
  }
}

TYPED_TEST(RoSyTest, RotationsFormAGroup) {
  constexpr int N = TypeParam::value;
  for (int a = 0; a < N; ++a) {
    EXPECT_EQ(RoSy<N>::compose(a, RoSy<N>::inverse(a)), 0);
    for (int b = 0; b < N; ++b) {
      const Vec3 n = Vec3(1, 2, 3).normalized(), o = any_tangent(n);
      const Vec3 twice = RoSy<N>::rotate(RoSy<N>::rotate(o, n, a), n, b);
      EXPECT_LT((twice - RoSy<N>::rotate(o, n, RoSy<N>::compose(a, b))).norm(), 1e-6f);
    }
  }
}

/// The closed form is the exact minimiser: no angle is larger than the least of all N^2 pairs.
TYPED_TEST(RoSyTest, MatchesExtrinsicallyLikeASearchOfAllPairs) {
  constexpr int N = TypeParam::value;
  Samples samples;
  for (int c = 0; c < cases; ++c) {
    const Sample s = samples.next();
    const Rotations k = RoSy<N>::match_extrinsic(s.oi, s.ni, s.oj, s.nj);
    ASSERT_TRUE(k.i >= 0 && k.i < N && k.j >= 0 && k.j < N);
    const double got = reference::angle(reference::rotate(N, v(s.oi), v(s.ni), k.i),
                                        reference::rotate(N, v(s.oj), v(s.nj), k.j));
    const double best = reference::match_extrinsic(N, v(s.oi), v(s.ni), v(s.oj), v(s.nj)).angle;
    // In terms of the cosine, which is what single precision compares.
    ASSERT_GE(std::cos(got), std::cos(best) - 5e-6) << "case " << c;
    // Any length of o_i gives the same.
    const Rotations scaled = RoSy<N>::match_extrinsic(0.25f * s.oi, s.ni, s.oj, s.nj);
    ASSERT_TRUE(scaled.i == k.i && scaled.j == k.j);
  }
}

TYPED_TEST(RoSyTest, MatchesIntrinsicallyLikeASearchOfAllRotations) {
  constexpr int N = TypeParam::value;
  Samples samples;
  for (int c = 0; c < cases; ++c) {
    const Sample s = samples.next();
    const Vec3 oji = transport(s.oj, s.nj, s.ni);
    const int k = RoSy<N>::match_intrinsic(s.oi, s.ni, oji);
    ASSERT_TRUE(k >= 0 && k < N);
    const double got = reference::angle(v(s.oi), reference::rotate(N, v(oji), v(s.ni), k));
    const double best = reference::match_intrinsic(N, v(s.oi), v(s.ni), v(oji)).angle;
    ASSERT_GE(std::cos(got), std::cos(best) - 5e-6) << "case " << c;
  }
}

TEST(Transport, IsTheSmallestRotationBetweenThePlanes) {
  Samples samples;
  for (int c = 0; c < cases; ++c) {
    const Sample s = samples.next();
    const Vec3 moved = transport(s.oj, s.nj, s.ni);
    const double cosine = v(s.ni).dot(v(s.nj));
    if (cosine < -0.9998) {
      // No rotation is smaller than the others: any tangent vector of the same length will do.
      ASSERT_NEAR(moved.norm(), 1, 2e-2);
      ASSERT_NEAR(moved.dot(s.ni), 0, 2e-2);
      continue;
    }
    // The division by 1 + cos loses what the cosine's rounding (1e-7) is of it.
    const double tolerance = 1e-6 + 4e-7 / (1 + cosine);
    ASSERT_LT((v(moved) - reference::unfold(v(s.oj), v(s.nj), v(s.ni))).norm(), tolerance)
        << "case " << c << " cosine " << cosine;
  }
}

TEST(AnyTangent, IsUnitAndTangent) {
  Samples samples;
  std::vector<Vec3> normals{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (std::size_t k = 0; k < 3; ++k) normals.push_back(-normals[k]);
  for (int c = 0; c < cases; ++c) normals.push_back(samples.unit());
  for (const Vec3& n : normals) {
    EXPECT_NEAR(any_tangent(n).norm(), 1, 1e-5);
    EXPECT_NEAR(any_tangent(n).dot(n), 0, 1e-5);
  }
}

}  // namespace
}  // namespace meshgrain
