#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <numeric>
#include <span>
#include <vector>

#include "field/running_share.h"
#include "meshgrain/fields.h"
#include "util/hash.h"

namespace meshgrain {

/// One node's part of a field on one level: everything that the solver below needs to know of an
/// energy and a symmetry. A kernel is a cheap view of the level's data.
template <typename K>
concept FieldKernel = requires(const K& kernel, Index i, std::size_t entry, std::uint64_t hash,
                               const typename K::Value* field, const typename K::Value& value,
                               std::span<const Index> nodes, const std::vector<Index>& parents,
                               typename K::Value* values, const typename K::Integers* integers) {
  /// A random value, from a hash of the node.
  { kernel.random(i, hash) } -> std::same_as<typename K::Value>;
  /// The local Gauss-Seidel step: the value of each node that fits its neighbours best.
  kernel.relax(nodes, field, values);
  /// The paper's energy of the edges that leave node i.
  { kernel.energy(i, field) } -> std::same_as<double>;
  /// The value of a node of a neighbouring level, for node i.
  { kernel.prolong(i, value) } -> std::same_as<typename K::Value>;
  /// The same for a range of nodes, from the values of all parents.
  kernel.prolong(parents, i, i, field, values);
  /// The mean of two values as one of node i, the first with the given share.
  { kernel.merge(i, value, value, 0.5f) } -> std::same_as<typename K::Value>;
  /// The same with integers held: those that match node i with the neighbour of an entry.
  { kernel.match(i, entry, field) } -> std::same_as<typename K::Integers>;
  { kernel.relax_frozen(i, field, integers) } -> std::same_as<typename K::Value>;
  { kernel.energy_frozen(i, field, integers) } -> std::same_as<double>;
};

/// The coarse-to-fine iteration that orientation and position fields share (sections 3.4, 3.5).
template <FieldKernel Kernel>
class Multiresolution {
 public:
  using Value = typename Kernel::Value;
  using Integers = typename Kernel::Integers;

  /// `kernels[l]` belongs to `hierarchy.levels[l]`. Both must outlive this.
  Multiresolution(const Hierarchy& hierarchy, const SolverOptions& options,
                  const std::vector<Kernel>& kernels, std::vector<EnergyRecord>& energies)
      : hierarchy_(hierarchy), options_(options), kernels_(kernels), energies_(energies) {
    level_ = options.multiresolution ? coarsest() : 0;
    const Kernel& kernel = kernels_[static_cast<std::size_t>(level_)];
    values_.resize(graph().size());
    for (Index i = 0; i < values_.size(); ++i) {
      values_[i] = kernel.random(i, hash64(options.seed, i));
    }
  }

  bool step(const Context& context) {
    context.check();
    if (!integers_.empty()) {
      sweep_frozen(context);
      return true;
    }
    if (done()) return false;
    if (sweep_ < sweeps()) {  // else it was cancelled before it could descend
      sweep(context);
      ++sweep_;
      if (options_.record_energy) energies_.push_back({level_, sweep_, energy(context)});
    }
    if (sweep_ >= sweeps() && level_ > 0) descend(context);
    return true;
  }

  int level() const { return level_; }
  bool done() const { return level_ == 0 && sweep_ >= sweeps(); }

  double progress() const {
    if (done()) return 1;
    // A level is twice the work of the next coarser one.
    const auto n = static_cast<double>(hierarchy_.levels[0].size());
    const auto m = static_cast<double>(graph().size());
    return std::min(1.0, m / n * (1.0 + 1.0 * sweep_ / sweeps()) / 2);
  }

  const std::vector<Value>& values() const { return values_; }

  /// Takes values of the finest level, as if all sweeps were done.
  void set_values(std::vector<Value> values) {
    values_ = std::move(values);
    integers_.clear();
    active_.clear();
    held_.clear();
    level_ = 0;
    sweep_ = sweeps();
    color_ = 0;
  }

  void restart(std::span<const Index> region) {
    integers_.clear();
    const int top = options_.multiresolution ? coarsest() : 0;
    held_.assign(static_cast<std::size_t>(top) + 1, {});
    active_.assign(static_cast<std::size_t>(top) + 1, {});
    held_[0] = values_;
    active_[0].assign(hierarchy_.levels[0].size(), 0);
    for (const Index i : region) active_[0][i] = 1;
    for (int l = 0; l < top; ++l) restrict_level(static_cast<std::size_t>(l));
    level_ = top;
    sweep_ = 0;
    color_ = 0;
    values_ = held_.back();
  }

  void freeze_integers(const Context& context) {
    active_.clear();  // of a restart on a region
    held_.clear();
    color_ = 0;
    const Graph& finest = hierarchy_.levels[0];
    auto integers = std::exchange(integers_, {});
    integers.resize(finest.neighbors.size());
    context.for_ranges(finest.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t e = finest.offsets[i]; e < finest.offsets[i + 1]; ++e) {
          integers[e] = kernels_[0].match(static_cast<Index>(i), e, values_.data());
        }
      }
    });
    integers_ = std::move(integers);
  }

  double energy(const Context& context) const {
    const Kernel& kernel = kernels_[static_cast<std::size_t>(level_)];
    const std::size_t n = values_.size();
    std::vector<double> parts((n + grain - 1) / grain, 0);
    context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const auto node = static_cast<Index>(i);
        sum += integers_.empty() ? kernel.energy(node, values_.data())
                                 : kernel.energy_frozen(node, values_.data(), integers_.data());
      }
      parts[begin / grain] = sum;
    });
    return std::accumulate(parts.begin(), parts.end(), 0.0);
  }

 private:
  static constexpr std::size_t grain = 2048;
  static constexpr std::size_t at_once = 16;  // nodes, as many as the widest SIMD units have lanes
  static constexpr std::size_t nodes_a_range = 256;  // at least: waking a thread takes as long

  int coarsest() const { return static_cast<int>(hierarchy_.levels.size()) - 1; }
  const Graph& graph() const { return hierarchy_.levels[static_cast<std::size_t>(level_)]; }
  const BlockColoring& coloring() const {
    return hierarchy_.colorings[static_cast<std::size_t>(level_)];
  }

  /// On the current level.
  int sweeps() const {
    if (options_.sweeps > 0) return options_.sweeps;
    constexpr int fine_levels = 3;
    constexpr std::size_t large = 30000;  // nodes: with enough levels below the fine ones
    if (!options_.multiresolution) return 6;
    if (level_ < fine_levels) return hierarchy_.levels[0].size() < large ? 2 : 1;
    // In short blocks less is passed on by a sweep.
    const int sweeps = coloring().block_size < BlockColoring::longest ? 8 : 6;
    return level_ == fine_levels ? sweeps : options_.coarse_factor * sweeps;
  }

  bool is_active(std::size_t i) const { return is_active(static_cast<std::size_t>(level_), i); }
  bool is_active(std::size_t level, std::size_t i) const {
    return active_.empty() || active_[level][i];
  }

  void sweep(const Context& context) {
    const Kernel& kernel = kernels_[static_cast<std::size_t>(level_)];
    const bool in_place = options_.schedule != Schedule::jacobi;
    std::vector<Value> next;
    if (!in_place) {
      next = values_;
      color_ = 0;  // nothing is left of a sweep that was cancelled
    }
    Value* results = in_place ? values_.data() : next.data();
    visit(
        [&](std::span<const Index> nodes) {
          std::array<Value, at_once> values;
          kernel.relax(nodes, values_.data(), values.data());
          for (std::size_t k = 0; k < nodes.size(); ++k) results[nodes[k]] = values[k];
        },
        context);
    if (!in_place) values_.swap(next);
  }

  void sweep_frozen(const Context& context) {
    visit(
        [&](std::span<const Index> nodes) {
          for (const Index i : nodes) {
            values_[i] = kernels_[0].relax_frozen(i, values_.data(), integers_.data());
          }
        },
        context);
  }

  /// Calls `body` for every node that is active, in the order of the schedule, with up to `at_once`
  /// of them that are no neighbours of each other.
  template <typename Body>
  void visit(const Body& body, const Context& context) {
    const std::size_t n = values_.size();
    if (options_.schedule == Schedule::random_order) {
      std::vector<std::pair<std::uint64_t, Index>> order(n);
      const std::uint64_t round = hash64(options_.seed + 1, ++rounds_);
      for (std::size_t i = 0; i < n; ++i) order[i] = {hash64(round, i), static_cast<Index>(i)};
      std::sort(order.begin(), order.end());
      for (const auto& [hash, i] : order) {
        if (is_active(i)) body(std::span(&i, 1));
      }
      return;
    }
    // Every block of a few goes on by one node, then all of them by the next one.
    const std::size_t size = coloring().block_size;
    const std::size_t batch = at_once * std::max<std::size_t>(1, nodes_a_range / (at_once * size));
    for (; color_ < coloring().colors.size(); ++color_) {
      const std::vector<Index>& blocks = coloring().colors[color_];
      context.for_ranges(blocks.size(), batch, [&](std::size_t begin, std::size_t end) {
        std::array<Index, at_once> nodes;
        for (std::size_t first = begin; first < end; first += at_once) {
          for (std::size_t place = 0; place < size; ++place) {
            std::size_t count = 0;
            for (std::size_t b = first; b < std::min(end, first + at_once); ++b) {
              const std::size_t i = blocks[b] * size + place;
              if (i < n && is_active(i)) nodes[count++] = static_cast<Index>(i);
            }
            if (count > 0) body(std::span<const Index>(nodes.data(), count));
          }
        }
      });
    }
    color_ = 0;
  }

  /// Copies the solution to the next finer level.
  void descend(const Context& context) {
    const auto l = static_cast<std::size_t>(level_) - 1;
    const std::vector<Index>& parents = hierarchy_.parents[l];
    std::vector<Value> finer(parents.size());
    context.for_ranges(finer.size(), grain, [&](std::size_t begin, std::size_t end) {
      kernels_[l].prolong(parents, static_cast<Index>(begin), static_cast<Index>(end),
                          values_.data(), finer.data());
      for (std::size_t i = begin; i < end; ++i) {
        if (!is_active(l, i)) finer[i] = held_[l][i];
      }
    });
    values_.swap(finer);
    --level_;
    sweep_ = 0;
  }

  /// The opposite, for restart(): values of level l + 1 from those of level l.
  void restrict_level(std::size_t l) {
    const Children& children = hierarchy_.children[l];
    held_[l + 1].resize(children.size());
    active_[l + 1].assign(children.size(), 0);
    for (Index k = 0; k < children.size(); ++k) {
      RunningShare share;
      Value& mean = held_[l + 1][k];
      bool first = true;
      for (const Index i : children[k]) {
        active_[l + 1][k] |= active_[l][i];
        const float before = share.add(hierarchy_.levels[l].areas[i]);
        mean = first ? kernels_[l + 1].prolong(k, held_[l][i])
                     : kernels_[l + 1].merge(k, mean, held_[l][i], before);
        first = false;
      }
    }
  }

  const Hierarchy& hierarchy_;
  SolverOptions options_;
  const std::vector<Kernel>& kernels_;
  std::vector<EnergyRecord>& energies_;
  int level_ = 0;
  int sweep_ = 0;
  std::size_t color_ = 0;  // the next of the sweep, which may be cancelled and go on later
  std::uint64_t rounds_ = 0;
  std::vector<Value> values_;  // of the current level
  std::vector<Integers> integers_;
  // Of a restart on a region: which nodes may change, and the values that the others keep.
  std::vector<std::vector<std::uint8_t>> active_;
  std::vector<std::vector<Value>> held_;
};

}  // namespace meshgrain
