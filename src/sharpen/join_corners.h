#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Makes one corner of corners that a line of marked edges shorter than `distance` joins, by
/// contracting its edges where the topology allows it: noise parts the lines that meet in one.
void join_near_corners(Mesh& triangles, double distance, const Context& context);

}  // namespace meshgrain
