#pragma once

#include "mesh/border.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// What bends by this much bends by about a right angle.
inline constexpr double about_right_degrees = 70;

/// What may meet a clean line that does.
enum class Beside {
  flat,    ///< Edges that are much flatter, as they must be anywhere.
  facets,  ///< Those between the sides of a prism of ten or more, as well.
};

/// Which share of the length of all edges sharper than `degrees` lies on clean lines. There an edge
/// goes on at both ends in another, as sharp and about as straight, or ends at a corner or at the
/// rim; and all others that meet it are much flatter. `edges` are all that are not flat. Splitting
/// edges or faces does not change the share.
double share_of_clean_lines(const Mesh& triangles, const RimAndSharpEdges& edges, double degrees,
                            Beside beside = Beside::flat);

}  // namespace meshgrain
