#include "extract/unit_carrier.h"

#include <algorithm>

namespace meshgrain {

UnitCarrier::UnitCarrier(const LatticeMesh& lattice)
    : lattice_(lattice),
      map_(lattice.map),
      posy_(lattice.posy),
      shift_(posy_ == 4 ? 2 : 3),
      turns_(map_.halfedges()),
      passable_(map_.halfedges(), 0),
      passing_(2 * states()) {
  for (Index h = 0; h < map_.halfedges(); ++h) {
    turns_[h] = static_cast<std::uint8_t>(lattice_.jump(h).rotation);
    if (lattice_.stands_for_triangle(h)) look_again(h);
  }
  weigh_lines();
}

/// What changes the length of a feature line must fit in between its ends: it costs more on a short
/// one.
void UnitCarrier::weigh_lines() {
  std::vector<int> edges;  // of each line
  for (Index h = 0; h < map_.halfedges(); h += 2) {
    if (map_.removed(h) || !lattice_.on_feature(h)) continue;
    const Index line = lattice_.lines[h / 2];
    if (line >= edges.size()) edges.resize(line + 1, 0);
    ++edges[line];
  }
  for (const int count : edges) line_weight_.push_back(std::max(1.0, 40.0 / std::max(count, 1)));
}

void UnitCarrier::look_again(Index h) {
  if (lattice_.holes[h]) return;
  const bool is_plane = lattice_.triangle(h).is_plane();
  for (int corner = 0; corner < 3; ++corner, h = map_.next(h)) {
    const std::size_t first = 2 * std::size_t{number({h, 0})};
    for (std::size_t k = 0; k < 2 * static_cast<std::size_t>(posy_); ++k) {
      passing_[first + k].store(0, std::memory_order_relaxed);
    }
    passable_[h] = is_plane;
  }
}

Jump UnitCarrier::left(const State& out) const {
  Jump jump = lattice_.jump(out.h);
  const auto u = vector(out.unit);
  jump.t = {jump.t[0] - u[0], jump.t[1] - u[1]};
  return jump;
}

int UnitCarrier::loss(Index h) const {
  return lattice_.metric().squared_length(lattice_.sum(h).t) == 1 ? 2 : 1;
}

bool UnitCarrier::shortens(const State& out) const {
  const LatticeMetric metric = lattice_.metric();
  const auto sum = lattice_.sum(out.h).t;
  const auto u = vector(out.unit);
  return metric.squared_length(std::array<int, 2>{sum[0] - u[0], sum[1] - u[1]}) <
         metric.squared_length(sum);
}

std::optional<int> UnitCarrier::gain(const State& in) const {
  if (passable_[in.h]) return std::nullopt;
  if (lattice_.holes[in.h]) return 0;
  const Jump sum = lattice_.sum(in.h);
  if (sum.rotation != 0) return 0;
  const auto u = vector(in.unit);
  const LatticeMetric metric = lattice_.metric();
  const double after = metric.squared_length(std::array<int, 2>{sum.t[0] + u[0], sum.t[1] + u[1]});
  if (after >= metric.squared_length(sum.t)) return std::nullopt;
  return after == 0 ? 2 : 1;
}

/// Lines of features stay on their axis, and keep their vertices apart.
bool UnitCarrier::may_leave(const State& out) const {
  if (!lattice_.on_feature(out.h)) return true;
  const Jump after = left(out);
  return !after.is_zero() && !lattice_.leaves_axis(out.h, after.t);
}

/// `worse`: what becomes of the triangle.
double UnitCarrier::step_cost(const State& out, double worse) const {
  const Index h = out.h;
  const double farther = lattice_.misfit(h, left(out).t) - lattice_.misfit(h, lattice_.jump(h).t);
  const double weight = lattice_.on_feature(h) ? line_weight_[lattice_.lines[h / 2]] : 1;
  return weight * std::max(farther, double{least_step}) + std::max(worse, 0.0);
}

float UnitCarrier::leaving(const State& out) const {
  if (!may_leave(out)) return forbidden;
  LatticeTriangle triangle = lattice_.triangle(out.h);
  const double before = triangle.misfit();
  triangle.around[0] = left(out);
  return static_cast<float>(step_cost(out, triangle.misfit() - before));
}

float UnitCarrier::ending(const State& in) const {
  if (lattice_.holes[in.h]) return 0;
  LatticeTriangle triangle = lattice_.triangle(in.h);
  const double before = triangle.misfit();
  triangle.around[0] = entered(in);
  return static_cast<float>(std::max(0.0, triangle.misfit() - before));
}

float UnitCarrier::passing(const State& in, int side) const {
  std::atomic<float>& stored =
      passing_[2 * std::size_t{number(in)} + static_cast<std::size_t>(side)];
  float cost = stored.load(std::memory_order_relaxed);
  if (cost > 0) return cost;
  State out = along(in);
  if (side == 1) out = along(out);
  cost = forbidden;
  if (may_leave(out)) {
    LatticeTriangle triangle = lattice_.triangle(in.h);
    const double before = triangle.misfit();
    triangle.around[0] = entered(in);
    triangle.around[side == 0 ? 1 : 2] = left(out);
    cost = static_cast<float>(step_cost(out, triangle.misfit() - before));
  }
  stored.store(cost, std::memory_order_relaxed);
  return cost;
}

}  // namespace meshgrain
