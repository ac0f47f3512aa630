#pragma once

#include "mesh/border.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Which share of the length of all edges sharper than `degrees` lies on clean lines. There an edge
/// goes on at both ends in another, as sharp and about as straight, or ends at a corner or at the
/// rim; and all others that meet it are much flatter. `edges` are all that are not flat. Splitting
/// edges or faces does not change the share.
double share_of_clean_lines(const Mesh& triangles, const RimAndSharpEdges& edges, double degrees);

}  // namespace meshgrain
