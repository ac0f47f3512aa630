#include "field/constraints.h"
#include "field/kernel_solver.h"
#include "field/position_kernel.h"
#include "field/running_share.h"
#include "field/with_symmetry.h"
#include "meshgrain/error.h"
#include "meshgrain/fields.h"
#include "util/bounding_box.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 2048;

/// Orientations and edge lengths of all levels, from those of the finest.
std::vector<LatticeFrame> restrict_frames(const Hierarchy& hierarchy,
                                          const OrientationField& orientation,
                                          const EdgeLength& edge_length, const Context& context) {
  std::vector<LatticeFrame> frames(hierarchy.levels.size());
  frames[0] = {orientation.directions, edge_length};
  for (std::size_t l = 0; l + 1 < frames.size(); ++l) {
    const Graph &fine = hierarchy.levels[l], &coarse = hierarchy.levels[l + 1];
    const LatticeFrame& finer = frames[l];
    std::vector<Vec3> directions(coarse.size());
    std::vector<float> lengths(edge_length.uniform() ? 0 : coarse.size());
    context.for_ranges(coarse.size(), grain, [&](std::size_t begin, std::size_t end) {
      restrict_orientations(fine, coarse, hierarchy.children[l], orientation.rosy,
                            static_cast<Index>(begin), static_cast<Index>(end),
                            finer.directions.data(), directions.data());
      if (lengths.empty()) return;
      for (std::size_t k = begin; k < end; ++k) {
        RunningShare share;
        for (const Index i : hierarchy.children[l][k]) {
          const float before = share.add(fine.areas[i]);
          const float length = finer.edge_length[i];
          lengths[k] = before > 0 ? before * lengths[k] + (1 - before) * length : length;
        }
      }
    });
    frames[l + 1] = {std::move(directions),
                     edge_length.uniform() ? edge_length : EdgeLength(std::move(lengths))};
  }
  return frames;
}

template <int S, PositionEnergy E>
class Solver final : public KernelSolver<PositionSolver, PositionKernel<S, E>> {
  using Kernel = PositionKernel<S, E>;

 public:
  Solver(const Hierarchy& hierarchy, std::vector<LatticeFrame> frames,
         const PositionOptions& options, std::span<const PositionConstraint> constraints,
         float extent)
      : hierarchy_(hierarchy),
        extent_(extent),
        frames_(std::move(frames)),
        constraints_(spread_constraints(hierarchy, constraints)) {
    this->begin(hierarchy, options, make_kernels());
  }

  PositionField field() const override { return {S, frames_[0].edge_length, this->values()}; }
  void set_field(const PositionField& field) override { this->set_values(field.points); }

  void set_constraints(std::span<const PositionConstraint> constraints) override {
    constraints_ = spread_constraints(hierarchy_, constraints);
    this->replace_kernels(make_kernels());
  }

 private:
  std::vector<Kernel> make_kernels() const {
    std::vector<Kernel> kernels;
    for (std::size_t l = 0; l < hierarchy_.levels.size(); ++l) {
      kernels.emplace_back(hierarchy_.levels[l], frames_[l], constraints_[l], extent_);
    }
    return kernels;
  }

  const Hierarchy& hierarchy_;
  const float extent_;  // of all positions
  std::vector<LatticeFrame> frames_;
  std::vector<LineConstraints> constraints_;
};

}  // namespace

std::unique_ptr<PositionSolver> PositionSolver::create(
    const Hierarchy& hierarchy, const OrientationField& orientation, const EdgeLength& edge_length,
    const PositionOptions& options, std::span<const PositionConstraint> constraints,
    const Context& context) {
  const std::size_t nodes = hierarchy.levels[0].size();
  if (orientation.directions.size() != nodes ||
      (!edge_length.uniform() && edge_length.values.size() != nodes)) {
    throw Error("positions need a direction, and one edge length or one for each, of every node");
  }
  if (orientation.rosy < 1 || options.posy % orientation.rosy != 0) {
    throw Error("a " + std::to_string(options.posy) + "-PoSy cannot follow a " +
                std::to_string(orientation.rosy) +
                "-RoSy: its symmetry must be a multiple of the orientation field's");
  }
  for (const float length : edge_length.values) {
    if (!(length > 0) || !std::isfinite(length)) {
      throw Error("the target edge length must be a positive number");
    }
  }
  auto frames = restrict_frames(hierarchy, orientation, edge_length, context);
  const float extent = hierarchy.levels[0].size() == 0
                           ? 1
                           : bounding_box(hierarchy.levels[0].positions, context).diagonal().norm();
  return with_posy(options.posy, [&]<int S>() -> std::unique_ptr<PositionSolver> {
    if (options.energy == PositionEnergy::intrinsic) {
      return std::make_unique<Solver<S, PositionEnergy::intrinsic>>(hierarchy, std::move(frames),
                                                                    options, constraints, extent);
    }
    return std::make_unique<Solver<S, PositionEnergy::extrinsic>>(hierarchy, std::move(frames),
                                                                  options, constraints, extent);
  });
}

PositionField solve_position(const Hierarchy& hierarchy, const OrientationField& orientation,
                             const EdgeLength& edge_length, const PositionOptions& options,
                             std::span<const PositionConstraint> constraints,
                             const Context& context) {
  const auto solver =
      PositionSolver::create(hierarchy, orientation, edge_length, options, constraints, context);
  solver->solve(context);
  return solver->field();
}

}  // namespace meshgrain
