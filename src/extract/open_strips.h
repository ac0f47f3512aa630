#pragma once

#include "extract/lattice_mesh.h"

namespace meshgrain {

/// Opens strips between two feature lines that are less than half an edge wide, as along the rims
/// of thin plates. In the lattice both lines are the same one, but both stay, so that faces must
/// lie between them: all edges across such a strip get a unit vector more, as far as it reaches,
/// around corners too. Its faces then are a row of the lattice like any other.
void open_strips(LatticeMesh& lattice);

}  // namespace meshgrain
