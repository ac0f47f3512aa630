#pragma once

#include <cstddef>
#include <vector>

#include "measure/crossings.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// What the faces are far from: limbs that were cut off, slits that were closed, edges of thin
/// parts that they keep inside of.
struct LostSurface {
  std::vector<Index> nodes;
  double faces = 0;  // that would cover it; or twice those of its largest patch, if these are more

  // What is hardly to be seen, before and after the faces are mended, which loses some more.
  static constexpr double little_before = 5, little = 8;
  // A finger that is gone shows more than as much that is missing here and there.
  static constexpr double weight_of_largest = 2;

  bool is_considerably_less_than(const LostSurface& other) const {
    return faces <= 0.7 * other.faces;
  }
};

/// Faces that are inverted, and pairs that pass through each other where that is not inherent.
struct FaultCounts {
  std::size_t inverted = 0, crossings = 0;

  std::size_t all() const { return inverted + crossings; }

  /// Faces that hardly touch each other.
  bool are_hardly_any() const {
    constexpr std::size_t touches = 3;
    return inverted == 0 && crossings <= touches;
  }

  /// No more faces are inverted, and all is less than two thirds as bad; or none is any more, and
  /// no more pass through each other.
  bool are_clearly_fewer_than(const FaultCounts& other) const {
    if (inverted > other.inverted) return false;
    if (inverted == 0 && other.inverted > 0 && crossings <= other.crossings) return true;
    return 3 * badness() < 2 * other.badness();
  }

  /// So many more that what is tried to get rid of some will hardly make them fewer.
  bool are_far_more_than(const FaultCounts& other) const { return badness() > 2 * other.badness(); }

 private:
  std::size_t badness() const { return 10 * inverted + crossings; }
};

/// And where they are.
struct Faults : FaultCounts {
  std::vector<Index> nodes;  // at these faces, of the surface before it was cut; increasing
  std::vector<Index> nodes_of_inverted;  // those of the former alone
};

/// What faces that are made otherwise may do without.
struct Flaws {
  double lost_faces = 0;  // if these are not little
  float flatness = 0;     // of the flattest quad, if that is nearly flat
  FaultCounts faults;
  std::size_t all_faults = 0;  // with inherent crossings, too

  /// A mesh that is crumpled all over is too coarse for its surface, and others would be as well.
  bool are_hopeless(std::size_t faces) const {
    return faults.all() > faces / hopeless || is_crumpled(all_faults, faces);
  }
  static constexpr std::size_t hopeless = 20;  // one in so many faces

  /// Others of a surface that passes through itself in many places do so, too, and take long.
  bool are_inherent(std::size_t faces) const { return all_faults > faces / many; }
  static constexpr std::size_t many = 10;  // one in so many faces

  bool any() const { return lost_faces > 0 || flatness > 0 || faults.all() > 0; }

  bool are_no_more_than(const Flaws& other) const {
    return lost_faces <= other.lost_faces && flatness <= other.flatness &&
           faults.all() <= other.faults.all() && all_faults <= other.all_faults;
  }

  /// None of them is more, and one is less; or faults are clearly fewer, at the price of quads that
  /// are flat at most.
  bool are_fewer_than(const Flaws& other) const {
    if (lost_faces > other.lost_faces || all_faults > other.all_faults) return false;
    if (faults.are_clearly_fewer_than(other.faults)) return true;
    return are_no_more_than(other) && (lost_faces < other.lost_faces || flatness < other.flatness ||
                                       faults.all() < other.faults.all());
  }
};

}  // namespace meshgrain
