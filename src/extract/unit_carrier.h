#pragma once

#include <hwy/cache_control.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "extract/lattice_mesh.h"
#include "meshgrain/context.h"

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
  UnitCarrier(const LatticeMesh& lattice, const Context& context);

  /// A unit vector at the origin of a halfedge, in steps of rotation from the first axis there. The
  /// halfedges of a triangle are sides 4 n, 4 n + 1 and 4 n + 2, one outside is a side 4 n.
  struct State {
    std::uint32_t side;
    int unit;
  };
  State state(Index h, int unit) const { return {sides_[h], unit}; }
  Index halfedge(const State& s) const { return halfedges_[s.side]; }

  /// States have numbers, those of a triangle near each other.
  std::uint32_t number(const State& s) const {
    return (s.side << shift_) + static_cast<std::uint32_t>(s.unit);
  }
  State state(std::uint32_t number) const {
    return {number >> shift_, static_cast<int>(number & ((1u << shift_) - 1))};
  }
  void prefetch(const State& s) const { hwy::Prefetch(&at(s)); }
  std::size_t states() const { return halfedges_.size() << shift_; }
  static std::uint32_t triangle(const State& s) { return s.side / 4; }
  std::size_t triangles() const { return triangles_.size(); }

  /// The same vector as seen from the origin of the next halfedge.
  State along(const State& s) const {
    const std::uint32_t k = s.side % 4;
    return {k == 2 ? s.side - 2 : s.side + 1, rotated(s.unit, at(s).turn[k])};
  }
  State back(const State& s) const {
    const std::uint32_t k = s.side % 4, last = k == 0 ? 2 : k - 1;
    return {s.side - k + last, rotated(s.unit, posy_ - at(s).turn[last])};
  }
  /// ... and from the other end of its edge, for the triangle there.
  State across(const State& s) const {
    const Triangle& triangle = at(s);
    return {triangle.across[s.side % 4], rotated(s.unit, triangle.turn[s.side % 4])};
  }

  State opposite(const State& s) const { return {s.side, rotated(s.unit, posy_ / 2)}; }

  /// What a unit can be: 0 to this less one.
  int units() const { return posy_; }

  /// How many irregular vertices vanish where a unit leaves the triangle of h for good.
  int loss(Index h) const;

  /// How many irregular vertices vanish if what has entered by `in` stays there; nothing if it can
  /// only pass.
  std::optional<int> gain(const State& in) const {
    return at(in).is_plane ? std::nullopt : gain_of_singular(in);
  }

  /// To leave costs at least a little, so that paths are no longer than they must be. It is
  /// `forbidden` where a feature line would leave its axis, and so is all that would move the apex
  /// of a cone away from a corner of the features.
  static constexpr float least_step = 0.05f;
  static constexpr float forbidden = std::numeric_limits<float>::infinity();

  /// What it costs to cross an edge, whatever becomes of the triangles beside it; this is the same
  /// for the opposite unit from the other side.
  float crossing(const State& out) const;
  /// The costs of leaving a triangle where nothing has entered, and of staying.
  float leaving(const State& out) const;
  float ending(const State& in) const;

  /// The costs of passing from one edge to the next two, along().
  std::array<float, 2> passing(const State& in) const;

  /// Whether a unit that leaves takes something from the Burgers vector of its triangle.
  bool shortens(const State& out) const;

  /// Whether feature lines stay on their axis, and keep their vertices apart.
  bool may_leave(const State& out) const;

  /// The jump of an edge after a unit vector has gone out through it.
  Jump left(const State& out) const;

  /// The triangle left of h has changed.
  void look_again(Index h);

 private:
  /// What a search asks for, in one line of the cache.
  struct alignas(64) Triangle {
    std::array<std::uint32_t, 3> across{};         // the sides on the other side
    std::array<std::array<float, 2>, 3> excess{};  // of the jumps over the real distances
    std::array<std::array<std::int16_t, 2>, 3> jumps{};
    std::array<std::uint8_t, 3> turn{};
    bool is_plane = false;
    bool is_simple = false;  // a plane off the feature lines
    std::int16_t area = 0;   // of a plane
  };

  const Triangle& at(const State& s) const { return triangles_[triangle(s)]; }
  int rotated(int unit, int steps) const {
    const int sum = unit + steps;
    return sum < posy_ ? sum : sum - posy_;
  }
  const std::array<int, 2>& vector(int unit) const {
    return vectors_[static_cast<std::size_t>(unit)];
  }
  Jump entered(const State& in) const { return left(opposite(in)); }
  float crossing(const std::array<float, 2>& excess, const std::array<int, 2>& unit) const;
  void look_at(Index h, Triangle& triangle) const;
  std::optional<int> gain_of_singular(const State& in) const;
  double worsening(Index h, const LatticeTriangle& after) const;
  float passing_slowly(const State& in, const State& out, std::size_t corner) const;
  void weigh_lines();

  const LatticeMesh& lattice_;
  const PolygonMap& map_;
  int posy_, shift_;
  std::array<std::array<int, 2>, 6> vectors_{};
  std::vector<Index> halfedges_;      // of each side
  std::vector<std::uint32_t> sides_;  // of each halfedge
  std::vector<Triangle> triangles_;
  std::vector<double> line_weight_;
};

}  // namespace meshgrain
