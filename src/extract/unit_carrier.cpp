#include "extract/unit_carrier.h"

#include <algorithm>
#include <cstdlib>

#include "meshgrain/error.h"

namespace meshgrain {

UnitCarrier::UnitCarrier(const LatticeMesh& lattice, const Context& context)
    : lattice_(lattice),
      map_(lattice.map),
      posy_(lattice.posy),
      shift_(posy_ == 4 ? 2 : 3),
      sides_(map_.halfedges(), no_index) {
  for (int unit = 0; unit < posy_; ++unit) {
    vectors_[static_cast<std::size_t>(unit)] = rotate_jump({1, 0}, unit, posy_);
  }
  for (Index h = 0; h < map_.halfedges(); ++h) {
    const bool stands = lattice_.stands_for_triangle(h);
    if (!stands && (map_.removed(h) || !lattice_.holes[h])) continue;
    const auto first = static_cast<std::uint32_t>(halfedges_.size());
    halfedges_.resize(first + 4, no_index);
    Index g = h;
    for (std::uint32_t k = 0; k < (stands ? 3 : 1); ++k, g = map_.next(g)) {
      halfedges_[first + k] = g;
      sides_[g] = first + k;
    }
  }
  if (states() >= no_index) throw Error("the result would have too many faces for one run");
  triangles_.resize(halfedges_.size() / 4);
  context.for_ranges(triangles_.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) look_at(halfedges_[4 * t], triangles_[t]);
  });
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
  const std::uint32_t t = triangle(state(h, 0));
  look_at(halfedges_[4 * t], triangles_[t]);
}

/// `h` is the first halfedge.
void UnitCarrier::look_at(Index h, Triangle& triangle) const {
  constexpr int most = 10000;  // else not simple
  triangle = {};
  if (lattice_.holes[h]) {
    triangle.across[0] = sides_[PolygonMap::twin(h)];
    triangle.turn[0] = static_cast<std::uint8_t>(lattice_.jump(h).rotation);
    return;  // where nothing leaves
  }
  const LatticeTriangle lattice_triangle = lattice_.triangle(h);
  triangle.is_plane = triangle.is_simple = lattice_triangle.is_plane();
  for (std::size_t k = 0; k < 3; ++k, h = map_.next(h)) {
    const Jump& jump = lattice_triangle.around[k];
    triangle.across[k] = sides_[PolygonMap::twin(h)];
    triangle.turn[k] = static_cast<std::uint8_t>(jump.rotation);
    const LatticePoint real = lattice_.real_jump(h);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      triangle.excess[k][axis] = static_cast<float>(jump.t[axis] - real[axis]);
      triangle.jumps[k][axis] = static_cast<std::int16_t>(jump.t[axis]);
      if (std::abs(jump.t[axis]) > most) triangle.is_simple = false;
    }
    if (lattice_.on_feature(h)) triangle.is_simple = false;
  }
  if (!triangle.is_simple) return;
  const double area = lattice_triangle.area();
  if (std::abs(area) > most) {
    triangle.is_simple = false;
  } else {
    triangle.area = static_cast<std::int16_t>(area);
  }
}

Jump UnitCarrier::left(const State& out) const {
  Jump jump = lattice_.jump(halfedge(out));
  const auto& u = vector(out.unit);
  jump.t = {jump.t[0] - u[0], jump.t[1] - u[1]};
  return jump;
}

int UnitCarrier::loss(Index h) const {
  return lattice_.metric().squared_length(lattice_.sum(h).t) == 1 ? 2 : 1;
}

bool UnitCarrier::shortens(const State& out) const {
  const LatticeMetric metric = lattice_.metric();
  const auto sum = lattice_.sum(halfedge(out)).t;
  const auto& u = vector(out.unit);
  return metric.squared_length(std::array<int, 2>{sum[0] - u[0], sum[1] - u[1]}) <
         metric.squared_length(sum);
}

std::optional<int> UnitCarrier::gain_of_singular(const State& in) const {
  const Index h = halfedge(in);
  if (lattice_.holes[h]) return 0;
  const Jump sum = lattice_.sum(h);
  if (sum.rotation != 0) return 0;
  const auto& u = vector(in.unit);
  const LatticeMetric metric = lattice_.metric();
  const double after = metric.squared_length(std::array<int, 2>{sum.t[0] + u[0], sum.t[1] + u[1]});
  if (after >= metric.squared_length(sum.t)) return std::nullopt;
  return after == 0 ? 2 : 1;
}

bool UnitCarrier::may_leave(const State& out) const {
  const Index h = halfedge(out);
  if (!lattice_.on_feature(h)) return true;
  const Jump after = left(out);
  return !after.is_zero() && !lattice_.spoils_line(h, after.t);
}

/// `excess` gains in length, squared, what it loses of a unit.
float UnitCarrier::crossing(const std::array<float, 2>& excess,
                            const std::array<int, 2>& unit) const {
  const auto u = static_cast<float>(unit[0]), v = static_cast<float>(unit[1]);
  float product = excess[0] * u + excess[1] * v;
  if (posy_ == 6) product += (excess[0] * v + excess[1] * u) / 2;
  return std::max(1 - 2 * product, least_step);
}

float UnitCarrier::crossing(const State& out) const {
  const float cost = crossing(at(out).excess[out.side % 4], vector(out.unit));
  const Index h = halfedge(out);
  if (!lattice_.on_feature(h)) return cost;
  return may_leave(out) ? static_cast<float>(line_weight_[lattice_.lines[h / 2]]) * cost
                        : forbidden;
}

float UnitCarrier::leaving(const State& out) const {
  LatticeTriangle triangle = lattice_.triangle(halfedge(out));
  triangle.around[0] = left(out);
  return static_cast<float>(crossing(out) + worsening(halfedge(out), triangle));
}

float UnitCarrier::ending(const State& in) const {
  const Index h = halfedge(in);
  if (lattice_.holes[h]) return 0;
  LatticeTriangle triangle = lattice_.triangle(h);
  triangle.around[0] = entered(in);
  return static_cast<float>(worsening(h, triangle));
}

std::array<float, 2> UnitCarrier::passing(const State& in) const {
  const Triangle& triangle = at(in);
  const State next = along(in), last = along(next);
  if (!triangle.is_simple) return {passing_slowly(in, next, 1), passing_slowly(in, last, 2)};
  const std::size_t n = next.side % 4, l = last.side % 4;
  const std::array<int, 2>&u = vector(next.unit), &w = vector(last.unit);
  // What a parallelogram with the third edge, the one that stays, says.
  const auto across_edge = [&](std::size_t k, const std::array<int, 2>& v) {
    return triangle.jumps[k][0] * v[1] - triangle.jumps[k][1] * v[0];
  };
  const double before = LatticeTriangle::misfit_of_plane(triangle.area);
  const auto cost = [&](std::size_t k, const std::array<int, 2>& v, int area) {
    const double worse = LatticeTriangle::misfit_of_plane(area) - before;
    return crossing(triangle.excess[k], v) + static_cast<float>(std::max(worse, 0.0));
  };
  return {cost(n, u, triangle.area + across_edge(l, w)),
          cost(l, w, triangle.area - across_edge(n, u))};
}

/// `out` is at a corner of the triangle, as seen from that of `in`.
float UnitCarrier::passing_slowly(const State& in, const State& out, std::size_t corner) const {
  LatticeTriangle triangle = lattice_.triangle(halfedge(in));
  triangle.around[0] = entered(in);
  triangle.around[corner] = left(out);
  return static_cast<float>(crossing(out) + worsening(halfedge(in), triangle));
}

/// What it costs a triangle from h on to become another.
double UnitCarrier::worsening(Index h, const LatticeTriangle& after) const {
  const LatticeTriangle before = lattice_.triangle(h);
  if (before.is_cone()) {
    for (int k = 0; k < 3; ++k, h = map_.next(h)) {
      if (lattice_.hold[map_.origin(h)] != at_corner) continue;
      if (before.sum(k).is_zero() && !after.sum(k).is_zero()) return forbidden;
    }
  }
  return std::max(0.0, after.misfit() - before.misfit());
}

}  // namespace meshgrain
