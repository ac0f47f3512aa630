#include "extract/open_strips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using Vector = std::array<int, 2>;  // of the lattice

constexpr Vector zero{0, 0};

Vector negative(const Vector& t) {
  return {-t[0], -t[1]};
}

class Opening {
 public:
  explicit Opening(LatticeMesh& lattice)
      : lattice_(lattice), map_(lattice.map), seen_(lattice.jumps.size(), 0) {}

  void run() {
    for (Index e = 0; e < seen_.size(); ++e) {
      if (seen_[e] || map_.removed(2 * e) || !lies_across(2 * e)) continue;
      if (const auto unit = unit_across(2 * e)) open({2 * e, *unit});
    }
  }

 private:
  /// An edge across a strip, with the unit vector to its target's side in the frame of its origin.
  struct Rung {
    Index h;
    Vector unit;
  };

  /// Whether an edge has no length, but the lines on both sides keep it from being collapsed.
  bool lies_across(Index h) const {
    return lattice_.jumps[h / 2].t == zero && !lattice_.on_feature(h) &&
           lattice_.hold[map_.origin(h)] != free_vertex &&
           lattice_.hold[map_.target(h)] != free_vertex;
  }

  /// A vector in the frame of h's target, seen from its origin, and the other way around.
  Vector from_target(Index h, const Vector& t) const {
    return rotate_jump(t, lattice_.posy - lattice_.jump(h).rotation, lattice_.posy);
  }
  Vector from_origin(Index h, const Vector& t) const {
    return rotate_jump(t, lattice_.jump(h).rotation, lattice_.posy);
  }

  /// The unit vector that points the most to the left of an edge.
  std::optional<Vector> unit_left_of(Index h) const {
    const Vector along = lattice_.jump(h).t;
    if (along == zero) return std::nullopt;
    Vector unit{1, 0}, best = unit;
    double most = 0;
    for (int k = 0; k < lattice_.posy; ++k, unit = rotate_jump(unit, 1, lattice_.posy)) {
      const double sine = std::sin(lattice_.metric().angle(along, unit));
      if (sine <= most) continue;
      most = sine;
      best = unit;
    }
    return best;
  }

  /// Told by a line along the strip, in the triangle left of h.
  std::optional<Vector> unit_by_line(Index h) const {
    if (lattice_.holes[h]) return std::nullopt;
    const Index ahead = map_.next(h), back = map_.prev(h);
    if (lattice_.on_feature(ahead)) {
      if (const auto left = unit_left_of(ahead)) return from_target(h, negative(*left));
    } else if (lattice_.on_feature(back)) {
      if (const auto left = unit_left_of(back)) return from_origin(back, *left);
    }
    return std::nullopt;
  }

  std::optional<Vector> unit_across(Index h) const {
    if (const auto unit = unit_by_line(h)) return unit;
    if (const auto unit = unit_by_line(PolygonMap::twin(h))) return from_target(h, negative(*unit));
    return std::nullopt;
  }

  bool has_width(const Rung& rung) const {
    const Vector t = lattice_.jump(rung.h).t;
    const Vector& u = rung.unit;
    return lattice_.posy == 4 ? t[0] * u[0] + t[1] * u[1] != 0 : t == u;
  }

  /// The next rung, beyond the triangle left of this one.
  std::optional<Rung> next(const Rung& rung) const {
    if (lattice_.holes[rung.h]) return std::nullopt;
    const Index ahead = map_.next(rung.h), back = map_.prev(rung.h);
    bool line_ahead = lattice_.on_feature(ahead), line_back = lattice_.on_feature(back);
    if (line_ahead && line_back) {  // one of them is the end of the strip, which goes on around it
      line_ahead = lattice_.jumps[back / 2].t == zero;
      line_back = lattice_.jumps[ahead / 2].t == zero;
    }
    if (line_ahead == line_back) return std::nullopt;
    Rung on = line_ahead ? Rung{PolygonMap::twin(back), rung.unit}
                         : Rung{PolygonMap::twin(ahead), from_target(back, rung.unit)};
    if (lattice_.triangle(rung.h).is_cone()) {
      // Around an apex it depends on the way: the lines beyond it tell.
      const auto unit = unit_across(on.h);
      if (!unit) return std::nullopt;
      on.unit = *unit;
    }
    return has_width(on) ? std::nullopt : std::optional(on);
  }

  /// Opens the strip as far as it reaches from a rung to both sides.
  void open(const Rung& start) {
    std::vector<Rung> rungs{start};
    seen_[start.h / 2] = 1;
    const auto go_on = [&](const Rung& from) {
      for (auto on = next(from); on; on = next(*on)) {
        if (std::exchange(seen_[on->h / 2], std::uint8_t{1})) return;
        rungs.push_back(*on);
      }
    };
    go_on(start);
    go_on({PolygonMap::twin(start.h), from_origin(start.h, negative(start.unit))});
    const double before = flaws_beside(rungs);
    for (const Rung& rung : rungs) add(rung.h, rung.unit);
    // Two lines may be near each other in one place only.
    if (flaws_beside(rungs) < before) return;
    for (const Rung& rung : rungs) add(rung.h, negative(rung.unit));
  }

  double flaws_beside(const std::vector<Rung>& rungs) const {
    std::vector<Index> triangles;
    for (const Rung& rung : rungs) {
      for (const Index h : {rung.h, PolygonMap::twin(rung.h)}) {
        if (!lattice_.holes[h]) triangles.push_back(std::min({h, map_.next(h), map_.prev(h)}));
      }
    }
    sort_unique(triangles);
    double sum = 0;
    for (const Index h : triangles) sum += lattice_.triangle(h).flaw();
    return sum;
  }

  void add(Index h, const Vector& t) {
    const Jump jump = lattice_.jump(h);
    lattice_.set_jump(h, {jump.rotation, {jump.t[0] + t[0], jump.t[1] + t[1]}});
  }

  LatticeMesh& lattice_;
  const PolygonMap& map_;
  std::vector<std::uint8_t> seen_;  // edges
};

}  // namespace

void open_strips(LatticeMesh& lattice) {
  Opening(lattice).run();
}

}  // namespace meshgrain
