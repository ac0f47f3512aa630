#include "field/position_kernel.h"

#include <gtest/gtest.h>

#include "field/orientation_kernel.h"
#include "made_graph.h"
#include "reference.h"
#include "relaxed.h"

namespace meshgrain {
namespace {

using reference::Lattice;
using reference::V;
using reference::v;

template <int S, PositionEnergy E>
struct Case {
  static constexpr int posy = S;
  static constexpr PositionEnergy energy = E;
};
constexpr auto extrinsic = PositionEnergy::extrinsic, intrinsic = PositionEnergy::intrinsic;

template <typename T>
class PositionKernelTest : public testing::Test {
 protected:
  static constexpr int S = T::posy;
  static constexpr PositionEnergy E = T::energy;
  using Kernel = PositionKernel<S, E>;

  Graph graph = made::noisy_graph();
  LatticeFrame frame = make_frame();
  LineConstraints none;
  std::vector<Vec3> field = random_field();

  LatticeFrame make_frame() const {
    const DirectionConstraints free;
    const OrientationKernel<S, OrientationEnergy::extrinsic> kernel(graph, free);
    LatticeFrame result;
    std::vector<float> lengths;
    for (Index i = 0; i < graph.size(); ++i) {
      result.directions.push_back(kernel.random(i, i));
      lengths.push_back(0.3f + 0.05f * made::noise(i));
    }
    for (int sweep = 0; sweep < 5; ++sweep) {
      for (Index i = 0; i < graph.size(); ++i) {
        result.directions[i] = made::relaxed(kernel, i, result.directions.data());
      }
    }
    result.edge_length = EdgeLength(std::move(lengths));
    return result;
  }

  std::vector<Vec3> random_field() const {
    const Kernel kernel(graph, frame, none, 3);
    std::vector<Vec3> values(graph.size());
    for (Index i = 0; i < graph.size(); ++i) values[i] = kernel.random(i, 77 + i);
    return values;
  }

  Lattice lattice(Index i, const V& p) const {
    return {S, p, v(frame.directions[i]), v(graph.normals[i]), frame.edge_length[i]};
  }

  /// The two sides of an edge: the points that the integers move the representatives to, and how
  /// certain the choice of them is.
  reference::Pair match(Index i, Index j, const V& pi) const {
    const V ni = v(graph.normals[i]), nj = v(graph.normals[j]);
    const V q = reference::intermediate(v(graph.positions[i]), ni, v(graph.positions[j]), nj);
    if (E == extrinsic) {
      const Lattice li = lattice(i, pi), lj = lattice(j, v(field[j]));
      reference::Pair pair = reference::match_lattices(li, lj, q);
      // The next cell has other corners: so close to its border rounding decides which cell it is.
      for (const Lattice* l : {&li, &lj}) {
        for (const V& axis : {l->o, reference::rotate(S, l->o, l->n, 1)}) {
          const double step = 1e-4 * l->rho;
          if (l->cell(q - step * axis) != l->cell(q + step * axis)) {
            pair.margin = 0;
          }
        }
      }
      return pair;
    }
    // Between parallel planes q_ij lies in neither: what is left out of the plane of i is no
    // distance within the surface.
    const V pji = reference::into_plane(q + reference::unfold(v(field[j]) - q, nj, ni),
                                        v(graph.positions[i]), ni);
    return reference::nearest_pair({pi}, lattice(i, pji).around(pi, 2));
  }

  struct Relaxed {
    V mean;
    double margin = 10;
  };

  /// Eq. 7 but for the rounding.
  Relaxed eq7(Index i) const {
    const V x = v(graph.positions[i]), n = v(graph.normals[i]);
    Relaxed result{v(field[i])};
    double total = 0;
    for (Index e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
      const reference::Pair pair = match(i, graph.neighbors[e], result.mean);
      const double w = graph.weight(e);
      result.mean = (total * pair.i + w * pair.j) / (total + w);
      result.mean = reference::into_plane(result.mean, x, n);
      result.margin = std::min(result.margin, pair.margin);
      total += w;
    }
    return result;
  }
};

using Cases =
    testing::Types<Case<4, extrinsic>, Case<6, extrinsic>, Case<4, intrinsic>, Case<6, intrinsic>>;
TYPED_TEST_SUITE(PositionKernelTest, Cases);

TYPED_TEST(PositionKernelTest, RelaxesByThePapersLocalIteration) {
  const typename TestFixture::Kernel kernel(this->graph, this->frame, this->none, 3);
  std::size_t uncertain = 0;
  for (int round = 0; round < 3; ++round) {
    for (Index i = 0; i < this->graph.size(); ++i) {
      const Vec3 got = made::relaxed(kernel, i, this->field.data());
      const auto expected = this->eq7(i);
      const double rho = this->frame.edge_length[i];
      if (expected.margin < 1e-4 * rho) {
        ++uncertain;
      } else {
        // The same lattice, and the point of it that is nearest to the node.
        const reference::Lattice lattice = this->lattice(i, expected.mean);
        const V x = v(this->graph.positions[i]);
        ASSERT_LT((lattice.nearest(v(got)) - v(got)).norm(), 1e-3 * rho)
            << "node " << i << " round " << round;
        ASSERT_LE((v(got) - x).norm(), (lattice.nearest(x) - x).norm() + 1e-3 * rho);
      }
      if (round > 0) this->field[i] = got;
    }
  }
  EXPECT_LT(uncertain, this->graph.size() / 5);
}

/// Eq. 5 and Eq. 6, in units of the edge length.
TYPED_TEST(PositionKernelTest, MeasuresThePapersEnergy) {
  const typename TestFixture::Kernel kernel(this->graph, this->frame, this->none, 3);
  for (const bool smooth : {false, true}) {
    double got = 0, expected = 0;
    for (Index i = 0; i < this->graph.size(); ++i) {
      double mine = 0;
      bool certain = true;
      const double rho = this->frame.edge_length[i];
      for (Index e = this->graph.offsets[i]; e < this->graph.offsets[i + 1]; ++e) {
        const auto pair = this->match(i, this->graph.neighbors[e], v(this->field[i]));
        mine += this->graph.weight(e) * pair.distance * pair.distance / (rho * rho);
        certain = certain && pair.margin > 0;
      }
      if (!certain) continue;
      expected += mine;
      got += kernel.energy(i, this->field.data());
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

/// Section 3.7: one of the two dimensions is held, by moving the point towards its projection onto
/// the plane spanned by the line's direction and the normal. Of the lattice's points the nearest to
/// the line is the one that is moved.
TYPED_TEST(PositionKernelTest, LinesInterpolate) {
  const typename TestFixture::Kernel free(this->graph, this->frame, this->none, 3);
  const std::size_t n = this->graph.size();
  for (const float strength : {0.0f, 0.25f, 0.5f, 1.0f}) {
    LineConstraints constraints;
    constraints.strengths.assign(n, strength);
    for (Index i = 0; i < n; ++i) {
      const Vec3& normal = this->graph.normals[i];
      const Vec3 along = this->frame.directions[i];
      // Along the lattice's rows, and not quite tangent.
      constraints.directions.push_back((along + 0.3f * made::noise(i) * normal).normalized());
      constraints.points.push_back(this->graph.positions[i] +
                                   0.1f * made::noise(i + n) * normal.cross(along) +
                                   0.05f * made::noise(i + 2 * n) * along);
    }
    const typename TestFixture::Kernel kernel(this->graph, this->frame, constraints, 3);
    for (Index i = 0; i < n; ++i) {
      const double rho = this->frame.edge_length[i];
      const V normal = v(this->graph.normals[i]), x = v(this->graph.positions[i]);
      const V c = v(constraints.points[i]), d = v(constraints.directions[i]);
      const reference::Lattice start =
          this->lattice(i, v(made::relaxed(free, i, this->field.data())));
      const V foot = c + d * d.dot(x - c);
      const auto near = start.around(foot, 2);
      if ((near[1] - foot).norm() - (near[0] - foot).norm() < 1e-3 * rho) continue;
      const V across = normal.cross(d).normalized();
      const V moved = near[0] - strength * across * across.dot(near[0] - c);
      const V got = v(made::relaxed(kernel, i, this->field.data()));
      const reference::Lattice expected = this->lattice(i, moved);
      ASSERT_LT((expected.nearest(got) - got).norm(), 2e-3 * rho)
          << "strength " << strength << " node " << i;
      if (strength == 1) {
        // A row of the lattice runs along the line.
        const double row =
            across.dot(got - c) / (rho * (TestFixture::S == 4 ? 1 : std::sqrt(0.75)));
        ASSERT_NEAR(row, std::round(row), 5e-3);
      }
    }
  }
}

TYPED_TEST(PositionKernelTest, PointsInterpolate) {
  const typename TestFixture::Kernel free(this->graph, this->frame, this->none, 3);
  const std::size_t n = this->graph.size();
  for (const float strength : {0.5f, 1.0f}) {
    LineConstraints constraints;
    constraints.strengths.assign(n, strength);
    constraints.directions.assign(n, Vec3::Zero());
    constraints.points = this->graph.positions;
    const typename TestFixture::Kernel kernel(this->graph, this->frame, constraints, 3);
    for (Index i = 0; i < n; ++i) {
      const V start = v(made::relaxed(free, i, this->field.data())),
              x = v(this->graph.positions[i]);
      const V got = v(made::relaxed(kernel, i, this->field.data()));
      ASSERT_LT((got - ((1 - strength) * start + strength * x)).norm(),
                2e-3 * this->frame.edge_length[i]);
    }
  }
}

TYPED_TEST(PositionKernelTest, ValuesAreTheNearestOfTheirLatticeAndInThePlane) {
  const typename TestFixture::Kernel kernel(this->graph, this->frame, this->none, 3);
  for (Index i = 0; i < this->graph.size(); ++i) {
    const V x = v(this->graph.positions[i]), n = v(this->graph.normals[i]);
    for (const Vec3& value :
         {kernel.random(i, i), made::relaxed(kernel, i, this->field.data()),
          kernel.prolong(i, this->graph.positions[i] + Vec3(1, 2, 3)),
          kernel.merge(i, this->field[i], this->field[(i + 1) % this->graph.size()], 0.3f)}) {
      ASSERT_NEAR(n.dot(v(value) - x), 0, 1e-5);
      const reference::Lattice lattice = this->lattice(i, v(value));
      ASSERT_LE((v(value) - x).norm(), (lattice.nearest(x) - x).norm() + 1e-5);
    }
  }
}

}  // namespace
}  // namespace meshgrain
