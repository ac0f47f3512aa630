#pragma once

#include "remesh/remaking.h"

namespace meshgrain {

/// Where borders lie exactly on each other, and faces beside these are bad, what there is once they
/// are joined: so programs write meshes that have several normals or texture coordinates at a
/// vertex. That is kept if it has fewer faults.
void try_joined_seams(Made& made, const RemeshOptions& options, const Make& make,
                      const Context& context);

/// What there is of a surface that has seams, without these.
Made made_without_seams(Remaking& remaking, Mesh surface, const Made& before);

}  // namespace meshgrain
