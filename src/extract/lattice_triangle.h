#pragma once

#include <array>

#include "field/jumps.h"

namespace meshgrain {

/// A point or vector of the lattice's plane, in edge lengths along its axes.
using LatticePoint = std::array<double, 2>;

/// What a lattice of the given symmetry measures.
struct LatticeMetric {
  int posy = 4;
  double squared_length(const LatticePoint& a) const;
  double squared_length(const std::array<int, 2>& t) const;
  /// The angle from a to b, in radians, between -pi and pi.
  double angle(const LatticePoint& a, const LatticePoint& b) const;
  double angle(const std::array<int, 2>& a, const std::array<int, 2>& b) const;
};

/// A triangle by the jumps of its three edges alone, each in the frame of the corner it leaves.
///
/// If they add up to nothing it lies in a plane. If they add up to a rotation it holds a
/// singularity of the orientation field and is a piece of a cone: the point that the rotation
/// leaves in its place is the apex. Else it holds a position singularity, and the sum is its
/// Burgers vector.
struct LatticeTriangle {
  int posy = 4;
  std::array<Jump, 3> around;

  /// In the frame of a corner.
  Jump sum(int corner = 0) const {
    return composed(composed(around[corner], around[(corner + 1) % 3], posy),
                    around[(corner + 2) % 3], posy);
  }
  /// Told by the rotations alone: most triangles are none.
  bool is_cone() const {
    return (around[0].rotation + around[1].rotation + around[2].rotation) % posy != 0;
  }
  bool is_plane() const { return sum().rotation == 0 && sum().is_zero(); }

  /// Twice the area, in cells: 1 for half a cell, negative if the triangle is turned over. That of
  /// a cone, up to its apex; with a Burgers vector, the mean of what the corners see.
  double area() const;

  /// The apex of a cone, from a corner.
  LatticePoint apex(int corner = 0) const;
  /// The angle around the apex of a cone: less or more than a full turn by the index.
  double apex_angle() const;

  /// The angle at a corner.
  double angle(int corner) const;

  /// What is wrong with the triangle: 0 if it has a positive area (in a cone, each part between an
  /// edge and the apex), 1 if it is flat, and more if it is turned over or goes around its apex too
  /// often or not often enough.
  double flaw() const;

  /// The same, but a triangle of more than half a cell, which gains a vertex, is as far from what
  /// should be as a flat one, which loses one to its neighbours.
  double misfit() const;
  static double misfit_of_plane(double area);

 private:
  double flaw_of_cone() const;
  double flat_area(bool is_plane) const;
};

}  // namespace meshgrain
