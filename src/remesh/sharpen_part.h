#pragma once

#include <string>
#include <vector>

#include "meshgrain/remesh.h"

namespace meshgrain {

/// Makes the creases of a mechanical part sharp that noise or a grid have hidden, unless the
/// options say where creases are or leave them out, and tells so in `notes`. Returns whether it
/// did: the marked edges are then all the creases. `face_side` is that of the output.
bool sharpen_part(Mesh& triangles, const RemeshOptions& options, double face_side,
                  std::vector<std::string>& notes, const Context& context);

/// Makes sharp creases of bends too narrow for faces to follow, under the same options, and tells
/// so in `notes`; and of wider ones, so that rows of faces run along them, whose faces are then to
/// be rounded again: if `roundings` is given, these go there. Returns whether there were any.
bool sharpen_narrow_bends(Mesh& triangles, const RemeshOptions& options, double face_side,
                          Mesh* roundings, std::vector<std::string>& notes, const Context& context);

}  // namespace meshgrain
