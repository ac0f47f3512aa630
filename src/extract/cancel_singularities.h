#pragma once

#include <cstddef>

#include "extract/lattice_mesh.h"

namespace meshgrain {

/// What may be spent for each irregular vertex that goes away.
struct CancellingCost {
  double usual;
  double where_graded;  ///< At singularities where the target edge length varies.
};

/// Removes position singularities, but for those that the lattice keeps, by changing integers along
/// paths from one to another, to a singularity of the orientation field, or to the border; the
/// cheapest first. The cost of a path is the sum over the edges crossed of how much farther
/// (squared, in edge lengths) the new jump is from the real distance of the ends, and over the
/// triangles passed of how much more is wrong with them (LatticeTriangle::misfit()). To cross an
/// edge of a short feature line costs several times that.
///
/// A large mesh is cut into pieces of about `at_once` triangles, or more where waves come far, so
/// many that they fit into the caches: several are done at a time, then two of them together, and
/// so on.
void cancel_position_singularities(LatticeMesh& lattice, const CancellingCost& most,
                                   const Context& context, std::size_t at_once = 1 << 13);

}  // namespace meshgrain
