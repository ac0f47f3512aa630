#pragma once

#include <vector>

#include "mesh/frame.h"

namespace meshgrain {

/// The fields of one surface at the nodes of a graph of (nearly) the same surface, which lies in
/// `frame`: each node takes the value of the nearest vertex.
class FieldTransfer {
 public:
  /// All but the context must outlive this. Throws Error if the fields have no values.
  FieldTransfer(const Fields& fields, const Graph& graph, const Frame& frame,
                const Context& context);

  OrientationField orientation() const;
  PositionField position() const;

  /// Whether the fields' surface is another one: in the mean, nodes lie farther from its vertices
  /// than a hundredth of the frame's unit, and than these do from each other.
  bool is_of_another_surface(const Context& context) const;

 private:
  const Fields& fields_;
  const Graph& graph_;
  const Frame& frame_;
  std::vector<Vec3> points_;    // the vertices of the fields' surface, in the frame
  std::vector<Index> nearest_;  // of them, to each node
};

}  // namespace meshgrain
