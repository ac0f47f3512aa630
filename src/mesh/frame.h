#pragma once

#include "meshgrain/context.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// A change of units in which every surface is about one unit large, so that squares and cubes of
/// lengths are safe in single precision however small or large the input is. The scale is a power
/// of two: no bit is lost on the way in or out.
struct Frame {
  double scale = 1;  ///< Input units a unit of the frame.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();

  Eigen::Vector3d inside(const Eigen::Vector3d& p) const { return (p - origin) / scale; }
};

Frame unit_frame(const Mesh& mesh, const Context& context = Context(1));

void enter(const Frame& frame, Mesh& mesh, const Context& context = Context(1));
void leave(const Frame& frame, Mesh& mesh);
void leave(const Frame& frame, Fields& fields);

}  // namespace meshgrain
