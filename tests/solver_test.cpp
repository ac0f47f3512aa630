#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <map>
#include <numeric>
#include <thread>

#include "made_graph.h"
#include "meshgrain/error.h"
#include "meshgrain/extract.h"
#include "meshgrain/fields.h"
#include "meshgrain/remesh.h"
#include "meshgrain/singularities.h"
#include "meshgrain/surface.h"

namespace meshgrain {
namespace {

constexpr OrientationEnergy orientation_energies[] = {
    OrientationEnergy::extrinsic, OrientationEnergy::intrinsic, OrientationEnergy::convex};
constexpr PositionEnergy position_energies[] = {PositionEnergy::extrinsic,
                                                PositionEnergy::intrinsic};
constexpr Schedule schedules[] = {Schedule::blocks, Schedule::random_order, Schedule::jacobi};

/// Every pair of symmetries that the paper uses: rosy divides posy.
constexpr std::pair<int, int> pairs[] = {{1, 4}, {2, 4}, {4, 4}, {1, 6}, {2, 6}, {6, 6}};

struct Shape {
  Mesh mesh;
  Hierarchy hierarchy;
  float edge_length;

  Shape(const char* name, double resolution, float noise)
      : mesh(made::shaken(sample_shape(name, resolution), noise)),
        hierarchy(build_hierarchy(build_graph(mesh))),
        edge_length(4 * static_cast<float>(edge_lengths(mesh).mean)) {}

  std::unique_ptr<OrientationSolver> orientation(const OrientationOptions& options) const {
    return OrientationSolver::create(hierarchy, options);
  }
  OrientationField field(int rosy) const {
    OrientationOptions options;
    options.rosy = rosy;
    return solve_orientation(hierarchy, options);
  }
};

const Shape& noisy_sphere() {
  static const Shape shape("sphere", 0.4, 0.01f);
  return shape;
}
const Shape& bracket() {
  static const Shape shape("bracket", 0.4, 0);
  return shape;
}

OrientationOptions orientation_options(int rosy,
                                       OrientationEnergy energy = OrientationEnergy::extrinsic) {
  OrientationOptions options;
  options.rosy = rosy;
  options.energy = energy;
  return options;
}
PositionOptions position_options(int posy, PositionEnergy energy = PositionEnergy::extrinsic) {
  PositionOptions options;
  options.posy = posy;
  options.energy = energy;
  return options;
}

/// Runs sweeps with frozen integers from a field that is as yet rough; the energy never rises, and
/// falls well below where it was.
void expect_descent(FieldSolver& solver, const std::string& what) {
  const Context context(2);
  solver.solve(context);
  solver.freeze_integers();
  double before = solver.energy(context);
  const double start = before;
  for (int sweep = 0; sweep < 8; ++sweep) {
    EXPECT_TRUE(solver.step(context));
    const double after = solver.energy(context);
    EXPECT_LE(after, before * (1 + 1e-6) + 1e-9) << what << " sweep " << sweep;
    before = after;
  }
  EXPECT_LT(before, 0.99 * start) << what;
}

TEST(Solver, FrozenSweepsNeverRaiseTheOrientationEnergy) {
  for (const Shape* shape : {&noisy_sphere(), &bracket()}) {
    for (const int rosy : {1, 2, 4, 6}) {
      for (const OrientationEnergy energy : orientation_energies) {
        OrientationOptions options = orientation_options(rosy, energy);
        options.sweeps = 1;
        options.multiresolution = false;
        expect_descent(*shape->orientation(options), "rosy " + std::to_string(rosy) + " energy " +
                                                         std::to_string(static_cast<int>(energy)));
      }
    }
  }
}

TEST(Solver, FrozenSweepsNeverRaiseThePositionEnergy) {
  for (const Shape* shape : {&noisy_sphere(), &bracket()}) {
    std::vector<float> varying(shape->hierarchy.levels[0].size());
    for (std::size_t i = 0; i < varying.size(); ++i) {
      varying[i] = shape->edge_length * (1 + 0.3f * made::noise(i / 20));
    }
    for (const auto& [rosy, posy] : pairs) {
      for (const PositionEnergy energy : position_energies) {
        for (const EdgeLength& length : {EdgeLength(shape->edge_length), EdgeLength(varying)}) {
          PositionOptions options = position_options(posy, energy);
          options.sweeps = 1;
          options.multiresolution = false;
          expect_descent(
              *PositionSolver::create(shape->hierarchy, shape->field(rosy), length, options),
              "rosy " + std::to_string(rosy) + " posy " + std::to_string(posy) + " energy " +
                  std::to_string(static_cast<int>(energy)) + (length.uniform() ? "" : " varying"));
        }
      }
    }
  }
}

/// Compares the energy on each level before its first sweep and after its last. On levels whose
/// nodes are more than `reach` apart, the integers of a position field match lattice points at
/// random, and some of them, of a handful of nodes each, may end worse than they began.
void expect_levels_end_lower(FieldSolver& solver, const Hierarchy& hierarchy, float reach,
                             const std::string& what) {
  const std::size_t levels = hierarchy.levels.size();
  const Context context(2);
  std::map<int, double> began;
  began[solver.level()] = solver.energy(context);
  while (solver.step(context)) {
    if (!began.contains(solver.level())) began[solver.level()] = solver.energy(context);
  }
  ASSERT_EQ(began.size(), levels);
  std::map<int, double> ended;
  int sweeps = 0;
  for (const EnergyRecord& record : solver.energies()) {
    ended[record.level] = record.energy;
    sweeps = record.sweep == 1 ? 1 : sweeps + 1;
    EXPECT_EQ(record.sweep, sweeps);
  }
  ASSERT_EQ(ended.size(), levels);
  double far_began = 0, far_ended = 0;
  for (const auto& [level, energy] : ended) {
    const Graph& graph = hierarchy.levels[static_cast<std::size_t>(level)];
    const double area = std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0);
    if (std::sqrt(area / static_cast<double>(graph.size())) > reach) {
      far_began += began[level];
      far_ended += energy;
      continue;
    }
    // The coarsest have a few nodes, whose energy may be all rounding.
    EXPECT_LE(energy, began[level] * (1 + 1e-5) + 1e-6) << what << " level " << level;
  }
  EXPECT_LE(far_ended, 1.2 * far_began) << what;
  EXPECT_LT(ended[0], 0.97 * began[0]) << what;
}

TEST(Solver, EachLevelEndsLowerThanItBegan) {
  for (const Shape* shape : {&noisy_sphere(), &bracket()}) {
    for (const auto& [rosy, posy] : pairs) {
      for (const OrientationEnergy energy :
           {OrientationEnergy::extrinsic, OrientationEnergy::intrinsic}) {
        OrientationOptions options = orientation_options(rosy, energy);
        options.sweeps = 6;
        options.record_energy = true;
        expect_levels_end_lower(
            *shape->orientation(options), shape->hierarchy, 1e9f,
            "rosy " + std::to_string(rosy) + " energy " + std::to_string(static_cast<int>(energy)));
      }
      for (const PositionEnergy energy : position_energies) {
        PositionOptions options = position_options(posy, energy);
        options.sweeps = 6;
        options.record_energy = true;
        expect_levels_end_lower(
            *PositionSolver::create(shape->hierarchy, shape->field(rosy), shape->edge_length,
                                    options),
            shape->hierarchy, shape->edge_length,
            "posy " + std::to_string(posy) + " energy " + std::to_string(static_cast<int>(energy)));
      }
    }
  }
}

/// Lets contexts have more threads than there are cores.
struct ManyThreads {
  tbb::global_control control{tbb::global_control::max_allowed_parallelism, 8};
};

TEST(Solver, AnyNumberOfThreadsGivesTheSameBytes) {
  const ManyThreads many;
  // Several blocks of nodes, or there would be nothing to do at once.
  static const Shape shape("blob", 1, 0);
  ASSERT_GT(shape.hierarchy.levels[0].size(), 4096u);
  for (const Schedule schedule : schedules) {
    OrientationOptions orientation = orientation_options(4);
    PositionOptions position = position_options(4);
    orientation.schedule = position.schedule = schedule;
    orientation.record_energy = true;
    std::vector<Vec3> directions, points;
    std::vector<double> energies;
    for (const int threads : {1, 2, 3, 8}) {
      const Context context(threads);
      const Hierarchy hierarchy = build_hierarchy(build_graph(shape.mesh, {}, context), context);
      const auto solver = OrientationSolver::create(hierarchy, orientation);
      solver->solve(context);
      const OrientationField field = solver->field();
      const PositionField lattice =
          solve_position(hierarchy, field, shape.edge_length, position, {}, context);
      std::vector<double> recorded;
      for (const EnergyRecord& record : solver->energies()) recorded.push_back(record.energy);
      if (threads == 1) {
        directions = field.directions;
        points = lattice.points;
        energies = recorded;
      }
      EXPECT_EQ(field.directions, directions) << threads;
      EXPECT_EQ(lattice.points, points) << threads;
      EXPECT_EQ(recorded, energies) << threads;
    }
  }
}

TEST(Solver, AnyNumberOfThreadsRemeshesAlike) {
  const ManyThreads many;
  for (const Schedule schedule : schedules) {
    RemeshOptions options;
    options.face_count = 1000;
    options.solver.schedule = schedule;
    Mesh first;
    for (const int threads : {1, 2, 3, 8}) {
      const Mesh mesh = remesh(sample_shape("bracket", 0.5), options, Context(threads)).mesh;
      if (threads == 1) first = mesh;
      EXPECT_EQ(mesh.positions, first.positions) << threads;
      EXPECT_TRUE(std::ranges::equal(mesh.faces.corners(), first.faces.corners())) << threads;
    }
  }
}

TEST(Solver, SeedsMakeTheDifference) {
  OrientationOptions options = orientation_options(4);
  const auto a = solve_orientation(noisy_sphere().hierarchy, options).directions;
  EXPECT_EQ(solve_orientation(noisy_sphere().hierarchy, options).directions, a);
  options.seed = 1;
  EXPECT_NE(solve_orientation(noisy_sphere().hierarchy, options).directions, a);
}

TEST(Solver, SteppingEqualsSolving) {
  const Context context(2);
  const Shape& shape = bracket();
  OrientationOptions options = orientation_options(4);
  const auto stepped = shape.orientation(options), solved = shape.orientation(options);
  int steps = 0;
  double progress = 0;
  int level = stepped->level();
  while (stepped->step(context)) {
    ++steps;
    EXPECT_GE(stepped->progress(), progress);
    EXPECT_LE(stepped->level(), level);
    progress = stepped->progress();
    level = stepped->level();
  }
  EXPECT_EQ(progress, 1);
  const std::vector<BlockColoring>& colorings = shape.hierarchy.colorings;
  ASSERT_GT(colorings.size(), 3u);
  int expected = 2 * 3;
  for (const BlockColoring& coloring : std::span(colorings).subspan(3)) {
    expected += coloring.block_size < BlockColoring::longest ? 8 : 6;
  }
  EXPECT_EQ(steps, expected);
  EXPECT_FALSE(stepped->step(context));
  solved->solve(context);
  EXPECT_EQ(stepped->field().directions, solved->field().directions);
}

/// The nodes within a distance of the first.
std::vector<Index> region_of(const Graph& graph, float radius) {
  std::vector<Index> region;
  for (Index i = 0; i < graph.size(); ++i) {
    if ((graph.positions[i] - graph.positions[0]).norm() < radius) region.push_back(i);
  }
  return region;
}

TEST(Solver, RestartChangesTheRegionOnlyAndSmoothsIt) {
  const Context context(2);
  const Shape& shape = noisy_sphere();
  const Graph& graph = shape.hierarchy.levels[0];
  const std::vector<Index> region = region_of(graph, 0.7f);
  ASSERT_GT(region.size(), 20u);
  ASSERT_LT(region.size(), graph.size() / 2);
  const auto check = [&](auto& solver, auto&& values, auto&& set) {
    solver.solve(context);
    const double good = solver.energy(context);
    auto field = solver.field();
    // Spoil the region.
    for (const Index i : region) values(field)[i] = set(i);
    const std::vector<Vec3> spoilt = values(field);
    solver.set_field(field);
    const double bad = solver.energy(context);
    EXPECT_GT(bad, 1.5 * good);
    solver.restart(region);
    solver.solve(context);
    EXPECT_LT(solver.energy(context), good + 0.2 * (bad - good));
    auto after = solver.field();
    std::vector<bool> inside(graph.size(), false);
    for (const Index i : region) inside[i] = true;
    std::size_t changed = 0;
    for (Index i = 0; i < graph.size(); ++i) {
      if (inside[i]) {
        changed += values(after)[i] != spoilt[i];
      } else {
        EXPECT_EQ(values(after)[i], spoilt[i]);
      }
    }
    EXPECT_GT(changed, region.size() / 2);
  };
  for (const Schedule schedule : schedules) {
    OrientationOptions orientation = orientation_options(4);
    PositionOptions position = position_options(4);
    orientation.schedule = position.schedule = schedule;
    const auto directions = shape.orientation(orientation);
    check(
        *directions, [](OrientationField& f) -> std::vector<Vec3>& { return f.directions; },
        [&](Index i) {
          const Vec3 any(made::noise(i), made::noise(i + 1), made::noise(i + 2));
          return graph.normals[i].cross(any).normalized();
        });
    const auto points =
        PositionSolver::create(shape.hierarchy, directions->field(), shape.edge_length, position);
    check(
        *points, [](PositionField& f) -> std::vector<Vec3>& { return f.points; },
        [&](Index i) {
          const Vec3 any(made::noise(i), made::noise(i + 1), made::noise(i + 2));
          return Vec3(graph.positions[i] + 0.5f * shape.edge_length * graph.normals[i].cross(any));
        });
  }
}

TEST(Solver, SetFieldIsWhatFieldGives) {
  const Context context(2);
  const Shape& shape = bracket();
  const auto a = shape.orientation(orientation_options(4)),
             b = shape.orientation(orientation_options(4));
  a->solve(context);
  b->set_field(a->field());
  EXPECT_FALSE(b->step(context));
  EXPECT_EQ(b->level(), 0);
  EXPECT_EQ(a->field().directions, b->field().directions);
  EXPECT_EQ(a->energy(context), b->energy(context));
}

/// A region that was restarted must not stay the only part that moves.
TEST(Solver, FreezingAfterARestartMovesEverything) {
  const Context context(2);
  const Shape& shape = noisy_sphere();
  const auto solver = shape.orientation(orientation_options(4));
  solver->solve(context);
  const Index region[1] = {0};
  solver->restart(region);
  solver->solve(context);
  const auto before = solver->field().directions;
  solver->freeze_integers();
  solver->step(context);
  const auto after = solver->field().directions;
  std::size_t moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i) moved += before[i] != after[i];
  EXPECT_GT(moved, before.size() / 2);
}

TEST(Solver, ConstraintsHoldAndCanBeChanged) {
  const Context context(2);
  const Shape& shape = noisy_sphere();
  const Graph& graph = shape.hierarchy.levels[0];
  const auto solver = shape.orientation(orientation_options(4));
  const Vec3 first = graph.normals[5].unitOrthogonal();
  const Vec3 second = (first + 0.7f * graph.normals[5].cross(first)).normalized();
  for (const Vec3& direction : {first, second}) {
    const OrientationConstraint constraint{5, direction, 1};
    solver->set_constraints({&constraint, 1});
    std::vector<Index> all(graph.size());
    std::iota(all.begin(), all.end(), Index{0});
    if (!solver->step(context)) solver->restart(all);
    solver->solve(context);
    const Vec3 got = solver->field().directions[5];
    const float along = std::abs(got.dot(direction));
    EXPECT_GT(std::max(along, std::sqrt(1 - std::min(1.0f, along * along))), 0.9999f);
  }
}

TEST(Solver, CancellationStopsEveryLongCall) {
  const Shape& shape = bracket();
  Context context(2);
  context.cancel();
  const auto orientation = shape.orientation(orientation_options(4));
  const OrientationField field = shape.field(4);
  const auto position = PositionSolver::create(shape.hierarchy, field, shape.edge_length, {});
  Mesh copy = shape.mesh;
  const PositionField points = solve_position(shape.hierarchy, field, shape.edge_length);
  const Graph& graph = shape.hierarchy.levels[0];
  EXPECT_THROW(orientation->step(context), Cancelled);
  EXPECT_THROW(orientation->solve(context), Cancelled);
  EXPECT_THROW(orientation->energy(context), Cancelled);
  EXPECT_THROW(position->solve(context), Cancelled);
  EXPECT_THROW(solve_orientation(shape.hierarchy, {}, {}, context), Cancelled);
  EXPECT_THROW(solve_position(shape.hierarchy, field, 0.1f, {}, {}, context), Cancelled);
  EXPECT_THROW(build_graph(shape.mesh, {}, context), Cancelled);
  EXPECT_THROW(build_hierarchy(graph, context), Cancelled);
  EXPECT_THROW(subdivide(copy, 0.001, context), Cancelled);
  EXPECT_THROW(extract_mesh(graph, field, points, {}, context), Cancelled);
  EXPECT_THROW(orientation_singularities(shape.mesh, graph.normals, field, context), Cancelled);
  EXPECT_THROW(remesh(shape.mesh, {}, context), Cancelled);
  // And once it is in the middle of things.
  Context later(2);
  int reports = 0;
  later.on_progress = [&](std::string_view, double) {
    if (++reports == 30) later.cancel();
  };
  EXPECT_THROW(remesh(shape.mesh, {}, later), Cancelled);
  EXPECT_EQ(reports, 30);
  // A cancelled solver goes on where it was.
  context.reset();
  orientation->solve(context);
  EXPECT_EQ(orientation->field().directions, field.directions);
}

/// Whenever that was: nothing is done twice, or left out.
TEST(Solver, CancellationLeavesNoTrace) {
  const Shape& shape = bracket();
  OrientationOptions options = orientation_options(4);
  options.sweeps = 300;
  const auto solver = shape.orientation(options);
  Context context(2);
  std::atomic<bool> is_done = false;
  std::thread canceller([&] {
    for (int k = 0; k < 3000 && !is_done; ++k) {
      context.cancel();
      std::this_thread::sleep_for(std::chrono::microseconds(20));
    }
    is_done = true;
  });
  int cancelled = 0;
  for (bool goes_on = true; goes_on;) {
    try {
      goes_on = solver->step(context);
    } catch (const Cancelled&) {
      ++cancelled;
      context.reset();
    }
  }
  is_done = true;
  canceller.join();
  EXPECT_GT(cancelled, 0);
  EXPECT_EQ(solver->field().directions, solve_orientation(shape.hierarchy, options).directions);
}

/// Figure 8. Equal sweeps over the finest level; those over all coarser ones cost about as much
/// again, so plain Gauss-Seidel is given twice as many, and more.
TEST(Solver, TheHierarchyBeatsPlainGaussSeidel) {
  static const Shape shape("blob", 0.6, 0);
  const Context context(2);
  const auto final_energy = [&](FieldSolver& solver) {
    solver.solve(context);
    return solver.energy(context);
  };
  OrientationOptions orientation = orientation_options(4);
  PositionOptions position = position_options(4);
  const OrientationField field = shape.field(4);
  const double with = final_energy(*shape.orientation(orientation));
  const double with_position =
      final_energy(*PositionSolver::create(shape.hierarchy, field, shape.edge_length, position));
  orientation.multiresolution = position.multiresolution = false;
  for (const Schedule schedule : {Schedule::blocks, Schedule::random_order}) {
    orientation.schedule = position.schedule = schedule;
    for (const int sweeps : {6, 12, 24}) {
      orientation.sweeps = position.sweeps = sweeps;
      EXPECT_LT(1.2 * with, final_energy(*shape.orientation(orientation))) << sweeps;
      EXPECT_LT(1.05 * with_position, final_energy(*PositionSolver::create(
                                          shape.hierarchy, field, shape.edge_length, position)))
          << sweeps;
    }
  }
}

/// Section 4: all nodes at once works too, though from the hierarchy, and with more sweeps.
TEST(Solver, JacobiFindsSmoothFields) {
  static const Shape shape("blob", 0.6, 0);
  const Context context(2);
  OrientationOptions options = orientation_options(4);
  const auto seidel = shape.orientation(options);
  seidel->solve(context);
  options.schedule = Schedule::jacobi;
  options.sweeps = 12;
  const auto jacobi = shape.orientation(options);
  const double start = jacobi->energy(context);
  EXPECT_GE(start, 0);
  jacobi->solve(context);
  EXPECT_LT(jacobi->energy(context), 1.5 * seidel->energy(context));
}

/// Knöppel's energy judged by the intrinsic one (section 4).
TEST(Solver, TheConvexEnergyGivesSmoothFields) {
  static const Shape shape("blob", 0.6, 0);
  const Context context(2);
  const auto convex = shape.orientation(orientation_options(4, OrientationEnergy::convex));
  const auto intrinsic = shape.orientation(orientation_options(4, OrientationEnergy::intrinsic));
  OrientationOptions plain = orientation_options(4, OrientationEnergy::intrinsic);
  plain.multiresolution = false;
  const auto rough = shape.orientation(plain);
  for (FieldSolver* solver :
       {static_cast<FieldSolver*>(convex.get()), static_cast<FieldSolver*>(intrinsic.get()),
        static_cast<FieldSolver*>(rough.get())}) {
    solver->solve(context);
  }
  EXPECT_LT(convex->energy(context), 1.5 * intrinsic->energy(context));
  EXPECT_LT(convex->energy(context), 0.7 * rough->energy(context));
  for (const Vec3& d : convex->field().directions) EXPECT_NEAR(d.norm(), 1, 1e-4);
}

TEST(Solver, RefusesWhatMakesNoSense) {
  const Shape& shape = noisy_sphere();
  OrientationOptions orientation;
  orientation.rosy = 3;
  EXPECT_THROW(shape.orientation(orientation), Error);
  PositionOptions position;
  position.posy = 5;
  EXPECT_THROW(PositionSolver::create(shape.hierarchy, shape.field(1), 0.1f, position), Error);
  position.posy = 6;
  EXPECT_THROW(PositionSolver::create(shape.hierarchy, shape.field(4), 0.1f, position), Error);
  position.posy = 4;
  EXPECT_THROW(PositionSolver::create(shape.hierarchy, shape.field(4), 0.0f, position), Error);
  OrientationField field = shape.field(4);
  field.rosy = 0;
  EXPECT_THROW(PositionSolver::create(shape.hierarchy, field, 0.1f, position), Error);
  field.rosy = 4;
  field.directions.pop_back();
  EXPECT_THROW(PositionSolver::create(shape.hierarchy, field, 0.1f, position), Error);
  const EdgeLength two_lengths(std::vector<float>{0.1f, 0.1f});
  EXPECT_THROW(PositionSolver::create(shape.hierarchy, shape.field(4), two_lengths, position),
               Error);
  const OrientationConstraint nowhere{1000000, Vec3::UnitX(), 1};
  EXPECT_THROW(OrientationSolver::create(shape.hierarchy, {}, {&nowhere, 1}), Error);
}

}  // namespace
}  // namespace meshgrain
