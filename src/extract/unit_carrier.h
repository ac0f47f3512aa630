#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "extract/lattice_mesh.h"

namespace meshgrain {

/// What it costs to carry unit vectors over a lattice mesh.
///
/// Whoever carries a unit vector u out of a triangle through one of its edges changes the edge's
/// jump by -u: the sum of the triangle loses u, and that of the next gains it, turned by the
/// rotation of the edge. So triangles on the way keep their sums, and a Burgers vector moves from
/// one end of the path to the other.
///
/// Several threads may ask at once; none while the lattice changes.
class UnitCarrier {
 public:
  explicit UnitCarrier(const LatticeMesh& lattice);

  /// A unit vector at the origin of a halfedge, in steps of rotation from the first axis there.
  struct State {
    Index h;
    int unit;
  };
  /// States have numbers, those of a halfedge one after another.
  std::size_t halfedges() const { return map_.halfedges(); }
  std::size_t states() const { return halfedges() << shift_; }
  std::uint32_t number(const State& s) const {
    return (s.h << shift_) + static_cast<std::uint32_t>(s.unit);
  }
  State state(std::uint32_t number) const {
    return {number >> shift_, static_cast<int>(number & ((1u << shift_) - 1))};
  }

  /// The same vector as seen from the origin of the next halfedge.
  State along(const State& s) const { return {map_.next(s.h), rotated(s.unit, turns_[s.h])}; }
  State back(const State& s) const {
    const Index h = map_.prev(s.h);
    return {h, rotated(s.unit, posy_ - turns_[h])};
  }
  /// ... and from the other end of its edge, for the triangle there.
  State across(const State& s) const {
    return {PolygonMap::twin(s.h), rotated(s.unit, turns_[s.h])};
  }

  /// What a unit can be: 0 to this less one.
  int units() const { return posy_; }

  /// How many irregular vertices vanish where a unit leaves the triangle of h for good.
  int loss(Index h) const;

  /// How many irregular vertices vanish if what has entered by `in` stays there; nothing if it can
  /// only pass.
  std::optional<int> gain(const State& in) const;

  /// The costs of leaving a triangle where nothing has entered, of passing from one edge to
  /// another, and of staying. To leave costs at least a little, so that paths are no longer than
  /// they must be, and is `forbidden` where a feature line would leave its axis.
  float leaving(const State& out) const;
  float passing(const State& in, int side) const;
  float ending(const State& in) const;
  static constexpr float least_step = 0.05f;
  static constexpr float forbidden = std::numeric_limits<float>::infinity();

  /// Whether a unit that leaves takes something from the Burgers vector of its triangle.
  bool shortens(const State& out) const;

  /// The jump of an edge after a unit vector has gone out through it.
  Jump left(const State& out) const;

  /// The triangle left of h has changed.
  void look_again(Index h);

 private:
  int rotated(int unit, int steps) const {
    const int sum = unit + steps;
    return sum < posy_ ? sum : sum - posy_;
  }
  std::array<int, 2> vector(int unit) const { return rotate_jump({1, 0}, unit, posy_); }
  Jump entered(const State& in) const { return left({in.h, rotated(in.unit, posy_ / 2)}); }
  bool may_leave(const State& out) const;
  double step_cost(const State& out, double worse) const;
  void weigh_lines();

  const LatticeMesh& lattice_;
  const PolygonMap& map_;
  int posy_, shift_;
  std::vector<std::uint8_t> turns_;     // of each halfedge: the rotation of its jump
  std::vector<std::uint8_t> passable_;  // of each halfedge: a plane on its left ends no path
  std::vector<double> line_weight_;
  // Of each state, for passing on to the next and to the previous edge; 0 if not known yet. Of all
  // that a search asks for this is the most work, and others ask again.
  mutable std::vector<std::atomic<float>> passing_;
};

}  // namespace meshgrain
