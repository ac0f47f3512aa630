#pragma once

#include "extract/lattice_mesh.h"
#include "meshgrain/context.h"

namespace meshgrain {

/// Makes the lattice whole by local changes that leave the surface and the integers around them as
/// they are: no edge of zero jump, no triangle turned over or flat, one vertex at each lattice
/// point, and edges as short as they can be. Then every triangle is half a cell (or a whole
/// triangle of a 6-PoSy) but for those with singularities.
void repair_lattice(LatticeMesh& lattice, const Context& context);

}  // namespace meshgrain
