#pragma once

#include "mesh/frame.h"

namespace meshgrain {

/// The fields of one surface at the nodes of a graph of (nearly) the same surface, which lies in
/// `frame`: each node takes the value of the nearest vertex.
OrientationField transfer_orientation(const Fields& fields, const Graph& graph, const Frame& frame,
                                      const Context& context);
PositionField transfer_position(const Fields& fields, const Graph& graph, const Frame& frame,
                                const Context& context);

}  // namespace meshgrain
