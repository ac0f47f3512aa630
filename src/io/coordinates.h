#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "io/input.h"
#include "meshgrain/mesh.h"

namespace meshgrain::io {

/// Collects the positions of a file, given in double precision, and stores them in single precision
/// relative to an origin: zero, unless the vertices lie so far from it that much would be lost
/// (|centre| > 16 |diagonal| of their bounding box); then the box's centre.
///
/// A part of such vertices lies nearly as far away as the whole: its centre is at most half the
/// diagonal from the whole's, so that |centre| > 15.5 |diagonal| for the part, too. As soon as the
/// vertices so far are closer, which takes but a few as a rule, the origin is known to be zero, and
/// no double is stored any more.
class Coordinates {
 public:
  void reserve(std::size_t count) { positions_.reserve(count); }
  std::size_t size() const { return positions_.size() + far_.size(); }

  /// The numbers must be finite in single precision.
  void push(double x, double y, double z) {
    if (near_) {
      positions_.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    } else {
      push_far({x, y, z});
    }
  }

  /// Takes all positions at once, before any other, if they need no origin. Else returns false.
  bool take_if_near(std::vector<Vec3>& positions, const Context& context);

  /// Sets the positions and the origin of `mesh`. Throws Error if there are no vertices or more
  /// than an Index can number.
  void move_to(Mesh& mesh, const Input& input);

 private:
  void push_far(const Eigen::Vector3d& p);
  void store(const Eigen::Vector3d& origin);

  std::vector<Vec3> positions_;
  std::vector<Eigen::Vector3d> far_;  // empty once near_
  Eigen::AlignedBox3d box_;
  bool near_ = false;  // the origin is zero for certain
};

}  // namespace meshgrain::io
