#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/hierarchy.h"

namespace meshgrain {

/// One unit tangent vector a node, that stands for itself and its rotations by 360 / rosy degrees
/// about the normal (section 3.2).
struct OrientationField {
  int rosy = 4;
  std::vector<Vec3> directions;
};

/// The target edge length: one for all nodes, or one a node.
struct EdgeLength {
  std::vector<float> values;
  EdgeLength(float uniform = 1) : values{uniform} {}
  explicit EdgeLength(std::vector<float> per_node) : values(std::move(per_node)) {}
  bool uniform() const { return values.size() == 1; }
  float operator[](std::size_t i) const { return values.size() == 1 ? values[0] : values[i]; }
};

/// One point in the tangent plane of each node, that stands for the square (posy = 4) or triangular
/// (6) lattice through it along the node's orientation; of the lattice's points the one nearest to
/// the node (section 3.3).
struct PositionField {
  int posy = 4;
  EdgeLength edge_length;
  std::vector<Vec3> points;
};

/// Both fields, with the surface that they live on: what one program writes and another reads.
struct Fields {
  Mesh surface;  ///< The triangle mesh or point cloud whose vertices are the nodes, with normals.
  OrientationField orientation;
  PositionField position;
  /// Of pure quads: whether their edges are as long as the lattice's (RemeshOptions::fine_lattice),
  /// not half as long.
  bool fine_lattice = false;
};

enum class OrientationEnergy {
  extrinsic,  ///< Angles in space (Eq. 4).
  intrinsic,  ///< Angles after unfolding (Eq. 2).
  convex,     ///< Knöppel et al. 2013, by local iteration (section 4).
};

enum class PositionEnergy {
  extrinsic,  ///< Distances in space (Eq. 6).
  intrinsic,  ///< Distances after unfolding (Eq. 5).
};

/// Pulls a node's orientation towards a direction (section 3.7). Strength 1 holds it fast.
struct OrientationConstraint {
  Index node = 0;
  Vec3 direction = Vec3::Zero();
  float strength = 1;
};

/// Pulls a node's lattice towards a line (through `point` along `direction`), or to the point
/// itself if the direction is zero (section 3.7).
struct PositionConstraint {
  Index node = 0;
  Vec3 point = Vec3::Zero();
  Vec3 direction = Vec3::Zero();
  float strength = 1;
};

enum class Schedule {
  blocks,        ///< Gauss-Seidel, blocks of nodes coloured so that neighbours never run at once.
  random_order,  ///< Gauss-Seidel in a new random order each sweep (section 3.4); one thread.
  jacobi,        ///< All nodes from the values of the sweep before (section 4).
};

struct SolverOptions {
  /// Gauss-Seidel sweeps on each level. 0: the paper's six (section 3.5), eight where blocks of
  /// nodes are short; but on each of the three finest levels only one, or two below 30,000 nodes,
  /// as more change nothing there that could be measured.
  int sweeps = 0;
  /// How many times as many on levels coarser than the fourth, if that is 0. They cost little.
  int coarse_factor = 1;
  Schedule schedule = Schedule::blocks;
  bool multiresolution = true;  ///< false: sweeps on the finest level only (Figure 8).
  std::uint64_t seed = 0;       ///< Of the random start.
  bool record_energy = false;   ///< Measure the energy after each sweep (as costly as the sweep).
};

/// The energy after a sweep: sums over all edges of a level, weighted, of squared angles (radians),
/// or of squared distances in edge lengths.
struct EnergyRecord {
  int level = 0;
  int sweep = 0;
  double energy = 0;
};

/// What an interactive program or a test can do with a running solver. The solver starts at the
/// coarsest level; each step is one sweep.
class FieldSolver {
 public:
  virtual ~FieldSolver() = default;

  /// One sweep. Returns false, and does nothing, when all levels are done.
  virtual bool step(const Context& context) = 0;

  /// All sweeps that are left.
  void solve(const Context& context) {
    while (step(context)) {
    }
  }

  /// The level (0 = finest) of the next step, and the share of the work done.
  virtual int level() const = 0;
  virtual double progress() const = 0;

  /// Starts again, but changes only these nodes: the others keep their values, also on coarser
  /// levels. For a region whose constraints or whose surface have changed. Call it when the solver
  /// is done.
  virtual void restart(std::span<const Index> region) = 0;

  /// Holds the integers of all edges of the finest level at what they are now; step() then changes
  /// only the fractional part, one sweep of the finest level a call, and always returns true
  /// (section 3.7). Call it when the solver is done.
  virtual void freeze_integers() = 0;

  /// The energy of the current values on the current level. With frozen integers this is the
  /// quadratic energy that the steps lower: chords for orientations, distances for positions.
  virtual double energy(const Context& context) const = 0;

  const std::vector<EnergyRecord>& energies() const { return energies_; }

 protected:
  std::vector<EnergyRecord> energies_;
};

struct OrientationOptions : SolverOptions {
  int rosy = 4;  ///< 1, 2, 4 or 6.
  OrientationEnergy energy = OrientationEnergy::extrinsic;
};

struct PositionOptions : SolverOptions {
  int posy = 4;  ///< 4 or 6.
  PositionEnergy energy = PositionEnergy::extrinsic;
};

/// Throws Error for an unknown symmetry. The hierarchy must outlive the solver.
class OrientationSolver : public FieldSolver {
 public:
  static std::unique_ptr<OrientationSolver> create(
      const Hierarchy& hierarchy, const OrientationOptions& options,
      std::span<const OrientationConstraint> constraints = {});
  /// The values at the finest level; valid once that is reached.
  virtual OrientationField field() const = 0;
  /// Starts from these values at the finest level, as if the solver had just ended there.
  virtual void set_field(const OrientationField& field) = 0;
  virtual void set_constraints(std::span<const OrientationConstraint> constraints) = 0;
};

/// Throws Error for an unknown symmetry, or one that the orientation field's does not divide
/// (posy must be a multiple of rosy, section 3.3). The hierarchy must outlive the solver.
class PositionSolver : public FieldSolver {
 public:
  static std::unique_ptr<PositionSolver> create(
      const Hierarchy& hierarchy, const OrientationField& orientation,
      const EdgeLength& edge_length, const PositionOptions& options,
      std::span<const PositionConstraint> constraints = {}, const Context& context = Context());
  virtual PositionField field() const = 0;
  virtual void set_field(const PositionField& field) = 0;
  virtual void set_constraints(std::span<const PositionConstraint> constraints) = 0;
};

/// The common case: all sweeps in one call.
OrientationField solve_orientation(const Hierarchy& hierarchy,
                                   const OrientationOptions& options = {},
                                   std::span<const OrientationConstraint> constraints = {},
                                   const Context& context = Context());
PositionField solve_position(const Hierarchy& hierarchy, const OrientationField& orientation,
                             const EdgeLength& edge_length, const PositionOptions& options = {},
                             std::span<const PositionConstraint> constraints = {},
                             const Context& context = Context());

}  // namespace meshgrain
