#pragma once

#include <cstdint>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Takes away the edges inside of a half that join two vertices of the mirror plane: there the two
/// halves would meet as well, and more than two faces. What is all triangles, or all quads, stays
/// so. `on_plane`: a flag a vertex; new ones are not on it, but where all around them are, as on a
/// limb that is one face wide, they go as far off it along `axis` as a round limb would.
void take_away_chords(Mesh& half, std::vector<std::uint8_t>& on_plane, int axis);

}  // namespace meshgrain
