#include <gtest/gtest.h>

#include <queue>

#include "field/orientation_kernel.h"
#include "field/position_kernel.h"
#include "made_graph.h"
#include "meshgrain/fields.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

/// The bracket with noise on, or without the faces of, a ball of a few edge lengths. The bounding
/// box stays, as random positions are drawn from it.
struct Damage {
  Mesh mesh;
  std::vector<Index> touched;  // vertices that moved, or lost a face
  Vec3 centre;
  float radius;
};

Damage damage(const Mesh& mesh, std::size_t vertex, float radius, bool remove) {
  Damage result{mesh, {}, mesh.positions[vertex], radius};
  const auto inside = [&](Index v) { return (mesh.positions[v] - result.centre).norm() < radius; };
  std::vector<bool> touched(mesh.positions.size(), false);
  result.mesh.faces.clear();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    const bool gone = inside(face[0]) && inside(face[1]) && inside(face[2]);
    if (!gone || !remove) result.mesh.faces.push_back(face);
    if (gone) touched[face[0]] = touched[face[1]] = touched[face[2]] = true;
  }
  const Mesh noisy = made::shaken(mesh, radius / 15);
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    if (!touched[v]) continue;
    result.touched.push_back(v);
    if (!remove) result.mesh.positions[v] = noisy.positions[v];
  }
  return result;
}

/// For each node, the least number of edges, in either graph, to one of `from`.
std::vector<int> hops(const Graph& a, const Graph& b, const std::vector<Index>& from) {
  std::vector<int> result(a.size(), -1);
  std::queue<Index> queue;
  for (const Index i : from) {
    result[i] = 0;
    queue.push(i);
  }
  while (!queue.empty()) {
    const Index i = queue.front();
    queue.pop();
    for (const Graph* graph : {&a, &b}) {
      for (const Index j : graph->neighbors_of(i)) {
        if (result[j] >= 0) continue;
        result[j] = result[i] + 1;
        queue.push(j);
      }
    }
  }
  return result;
}

struct Solved {
  Hierarchy hierarchy;
  OrientationField orientation;
  PositionField position;
  const Graph& graph() const { return hierarchy.levels[0]; }
};

Solved solve(const Mesh& mesh, float edge_length, const SolverOptions& options = {}) {
  Solved solved;
  solved.hierarchy = build_hierarchy(build_graph(mesh));
  OrientationOptions orientation;
  PositionOptions position;
  static_cast<SolverOptions&>(orientation) = options;
  static_cast<SolverOptions&>(position) = options;
  solved.orientation = solve_orientation(solved.hierarchy, orientation);
  solved.position = solve_position(solved.hierarchy, solved.orientation, edge_length, position);
  return solved;
}

/// The local iteration itself: a value depends on its neighbours', so that after k sweeps of all
/// nodes at once nothing further than k edges from a change can tell.
TEST(Locality, SweepsReachOneEdgeFurtherEach) {
  const Mesh mesh = sample_shape("bracket");
  const float rho = 4 * static_cast<float>(edge_lengths(mesh).mean);
  SolverOptions options;
  options.sweeps = 6;
  options.schedule = Schedule::jacobi;
  options.multiresolution = false;
  const Solved whole = solve(mesh, rho, options);
  for (const bool remove : {false, true}) {
    const Damage damaged = damage(mesh, mesh.positions.size() / 2, rho, remove);
    ASSERT_GT(damaged.touched.size(), 10u);
    const Solved part = solve(damaged.mesh, rho, options);
    const std::vector<int> distance = hops(whole.graph(), part.graph(), damaged.touched);
    std::size_t far = 0, near = 0;
    for (Index i = 0; i < mesh.positions.size(); ++i) {
      // Normals next to a moved vertex are others too; positions follow the orientations.
      if (distance[i] > options.sweeps + 1) {
        EXPECT_EQ(whole.orientation.directions[i], part.orientation.directions[i]);
      } else {
        near += whole.orientation.directions[i] != part.orientation.directions[i];
      }
      if (distance[i] > 2 * options.sweeps + 1) {
        EXPECT_EQ(whole.position.points[i], part.position.points[i]);
        ++far;
      }
    }
    EXPECT_GT(near, damaged.touched.size());
    EXPECT_GT(far, mesh.positions.size() / 10);
  }
}

/// Mending fields after damage: from the fields as they were, a restart on what lies within two
/// edge lengths of the damage changes nothing beyond, to the last bit. It forgets the old values on
/// the coarse levels, and may end at a worse lattice in one place and a better one in the next:
/// over many places it ends as smooth as they were.
TEST(Locality, ARestartMendsTheRegionOnly) {
  const Context context(2);
  const Mesh mesh = sample_shape("bracket");
  const float rho = 4 * static_cast<float>(edge_lengths(mesh).mean);
  const Solved whole = solve(mesh, rho);
  double before[2] = {}, after[2] = {};  // energies of orientations and positions
  for (int place = 0; place < 12; ++place) {
    const bool remove = place % 2 == 1;
    SCOPED_TRACE("place " + std::to_string(place));
    const std::size_t vertex = mesh.positions.size() * (static_cast<std::size_t>(place) + 1) / 13;
    const Damage damaged = damage(mesh, vertex, rho, remove);
    const Hierarchy hierarchy = build_hierarchy(build_graph(damaged.mesh));
    const auto near = [&](Index i) {
      return (mesh.positions[i] - damaged.centre).norm() < 3 * rho;
    };
    std::vector<Index> region;
    for (Index i = 0; i < mesh.positions.size(); ++i) {
      if (near(i)) region.push_back(i);
    }
    ASSERT_LT(region.size(), mesh.positions.size() / 2);
    // The old values, in the new tangent planes.
    OrientationField start = whole.orientation;
    for (const Index i : region) {
      const Vec3& n = hierarchy.levels[0].normals[i];
      Vec3& d = start.directions[i];
      d = (d - n * n.dot(d)).normalized();
    }
    const auto mend = [&](auto& solver, const auto& field, int which) {
      solver.set_field(field);
      const double energy = solver.energy(context);
      solver.restart(region);
      solver.solve(context);
      EXPECT_LT(solver.energy(context), 1.25 * energy);
      before[which] += energy;
      after[which] += solver.energy(context);
      return solver.field();
    };
    const auto orientation = OrientationSolver::create(hierarchy, {});
    const OrientationField directions = mend(*orientation, start, 0);
    const auto position = PositionSolver::create(hierarchy, directions, rho, {});
    const PositionField points = mend(*position, whole.position, 1);
    for (Index i = 0; i < mesh.positions.size(); ++i) {
      if (near(i)) continue;
      EXPECT_EQ(directions.directions[i], whole.orientation.directions[i]);
      EXPECT_EQ(points.points[i], whole.position.points[i]);
    }
  }
  EXPECT_LT(after[0], before[0]);
  EXPECT_LT(after[1], before[1]);
}

/// Between two crosses at one node, in degrees: at most 45.
double angle_between(const Vec3& a, const Vec3& b, const Vec3& n) {
  const double c = std::abs(a.dot(b)), s = std::abs(n.cross(a).dot(b));
  return std::atan2(std::min(c, s), std::max(c, s)) * 180 / std::numbers::pi;
}

/// A new solve of everything starts from coarse levels that stand for the whole surface, so every
/// value may change. Features pin the orientations: beyond four edge lengths from the damage nine
/// tenths of the crosses and more are where they were (the others lie on flat or round parts that
/// let singularities settle elsewhere), and both fields are about as smooth there. Which of the
/// equally good lattices is found where nothing pins it, is another matter: the positions
/// themselves are not compared.
TEST(Locality, ANewSolveIsAsGoodAwayFromTheDamage) {
  const Mesh mesh = sample_shape("bracket", 2);
  const float rho = 4 * static_cast<float>(edge_lengths(mesh).mean);
  const Solved whole = solve(mesh, rho);
  for (const std::size_t sixth : {1u, 3u, 5u}) {
    for (const bool remove : {false, true}) {
      SCOPED_TRACE(std::to_string(sixth) + (remove ? " removed" : " noise"));
      const Damage damaged = damage(mesh, mesh.positions.size() * sixth / 6, 1.5f * rho, remove);
      const Solved part = solve(damaged.mesh, rho);
      std::size_t count = 0, turned = 0;
      double energy[2] = {}, position_energy[2] = {};
      const Solved* solved[2] = {&whole, &part};
      for (int k = 0; k < 2; ++k) {
        const Solved& s = *solved[k];
        const DirectionConstraints free;
        const LineConstraints unbound;
        const LatticeFrame frame{s.orientation.directions, rho};
        const OrientationKernel<4, OrientationEnergy::extrinsic> crosses(s.graph(), free);
        const PositionKernel<4, PositionEnergy::extrinsic> lattices(s.graph(), frame, unbound, 1);
        for (Index i = 0; i < mesh.positions.size(); ++i) {
          if ((mesh.positions[i] - damaged.centre).norm() < damaged.radius + 4 * rho) continue;
          energy[k] += crosses.energy(i, s.orientation.directions.data());
          position_energy[k] += lattices.energy(i, s.position.points.data());
          if (k == 0) continue;
          ++count;
          turned += angle_between(whole.orientation.directions[i], part.orientation.directions[i],
                                  whole.graph().normals[i]) > 10;
        }
      }
      ASSERT_GT(count, mesh.positions.size() / 2);
      EXPECT_LT(turned, count / 10);  // measured 0.2 to 5.4 %
      // Measured 1.00 to 1.11, and 0.87 to 1.33.
      EXPECT_NEAR(energy[1] / energy[0], 1, 0.2);
      EXPECT_NEAR(position_energy[1] / position_energy[0], 1, 0.5);
    }
  }
}

}  // namespace
}  // namespace meshgrain
