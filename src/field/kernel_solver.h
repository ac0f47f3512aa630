#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "field/multiresolution.h"

namespace meshgrain {

/// What the solvers of both fields have in common: a kernel a level, and the iteration over them.
/// `Solver` is the public interface. A derived class makes the kernels and hands them over with
/// begin(); what the kernels look at must outlive them and stay in place.
template <typename Solver, FieldKernel Kernel>
class KernelSolver : public Solver {
 public:
  bool step(const Context& context) override { return iteration_->step(context); }
  int level() const override { return iteration_->level(); }
  double progress() const override { return iteration_->progress(); }
  void restart(std::span<const Index> region) override { iteration_->restart(region); }
  void freeze_integers() override { iteration_->freeze_integers(Context(1)); }
  double energy(const Context& context) const override { return iteration_->energy(context); }

 protected:
  using Values = std::vector<typename Kernel::Value>;

  void begin(const Hierarchy& hierarchy, const SolverOptions& options,
             std::vector<Kernel> kernels) {
    kernels_ = std::move(kernels);
    iteration_ =
        std::make_unique<Multiresolution<Kernel>>(hierarchy, options, kernels_, this->energies_);
  }

  /// The same data in other places: after a change of constraints.
  void replace_kernels(std::vector<Kernel> kernels) { kernels_ = std::move(kernels); }

  const Values& values() const { return iteration_->values(); }
  void set_values(Values values) { iteration_->set_values(std::move(values)); }

 private:
  std::vector<Kernel> kernels_;
  std::unique_ptr<Multiresolution<Kernel>> iteration_;
};

}  // namespace meshgrain
