#include "field/constraints.h"
#include "field/kernel_solver.h"
#include "field/orientation_kernel.h"
#include "field/with_symmetry.h"
#include "meshgrain/fields.h"

namespace meshgrain {
namespace {

template <int N, OrientationEnergy E>
class Solver final : public KernelSolver<OrientationSolver, OrientationKernel<N, E>> {
  using Kernel = OrientationKernel<N, E>;

 public:
  Solver(const Hierarchy& hierarchy, const OrientationOptions& options,
         std::span<const OrientationConstraint> constraints)
      : hierarchy_(hierarchy), constraints_(spread_constraints(hierarchy, N, constraints)) {
    this->begin(hierarchy, options, make_kernels());
  }

  OrientationField field() const override {
    OrientationField field{N, this->values()};
    // Only the convex energy leaves the length free. Values that are unit stay as they are, to the
    // last bit, so that field() gives what set_field() took.
    for (Vec3& d : field.directions) {
      const float length = d.norm();
      if (length > 0 && std::fabs(length - 1) > 1e-5f) d /= length;
    }
    return field;
  }

  void set_field(const OrientationField& field) override { this->set_values(field.directions); }

  void set_constraints(std::span<const OrientationConstraint> constraints) override {
    constraints_ = spread_constraints(hierarchy_, N, constraints);
    this->replace_kernels(make_kernels());
  }

 private:
  std::vector<Kernel> make_kernels() const {
    std::vector<Kernel> kernels;
    for (std::size_t l = 0; l < hierarchy_.levels.size(); ++l) {
      kernels.emplace_back(hierarchy_.levels[l], constraints_[l]);
    }
    return kernels;
  }

  const Hierarchy& hierarchy_;
  std::vector<DirectionConstraints> constraints_;
};

}  // namespace

std::unique_ptr<OrientationSolver> OrientationSolver::create(
    const Hierarchy& hierarchy, const OrientationOptions& options,
    std::span<const OrientationConstraint> constraints) {
  return with_rosy(options.rosy, [&]<int N>() -> std::unique_ptr<OrientationSolver> {
    switch (options.energy) {
      case OrientationEnergy::intrinsic:
        return std::make_unique<Solver<N, OrientationEnergy::intrinsic>>(hierarchy, options,
                                                                         constraints);
      case OrientationEnergy::convex:
        return std::make_unique<Solver<N, OrientationEnergy::convex>>(hierarchy, options,
                                                                      constraints);
      default:
        return std::make_unique<Solver<N, OrientationEnergy::extrinsic>>(hierarchy, options,
                                                                         constraints);
    }
  });
}

OrientationField solve_orientation(const Hierarchy& hierarchy, const OrientationOptions& options,
                                   std::span<const OrientationConstraint> constraints,
                                   const Context& context) {
  const auto solver = OrientationSolver::create(hierarchy, options, constraints);
  solver->solve(context);
  return solver->field();
}

}  // namespace meshgrain
