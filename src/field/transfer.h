#pragma once

#include "mesh/frame.h"

namespace meshgrain {

/// The fields of one surface at the nodes of a graph of (nearly) the same surface, which lies in
/// `frame`: each node takes the value of the nearest vertex.
OrientationField transfer_orientation(const Fields& fields, const Graph& graph, const Frame& frame,
                                      const Context& context);
PositionField transfer_position(const Fields& fields, const Graph& graph, const Frame& frame,
                                const Context& context);

/// Whether the fields' surface is another one: in the mean, nodes lie farther from its vertices
/// than a hundredth of the frame's unit, and than these do from each other.
bool is_of_another_surface(const Fields& fields, const Graph& graph, const Frame& frame,
                           const Context& context);

}  // namespace meshgrain
