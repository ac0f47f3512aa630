#pragma once

#include "remesh/remaking.h"

namespace meshgrain {

/// Where a few faces are inverted or pass through each other, as around a handle, between two bores
/// or in engraved letters that are smaller than a face: what there is with smaller faces near them,
/// and others a little larger for it. That is kept, with a note, if it has clearly fewer faults.
void try_finer_faces(Made& made, const RemeshOptions& options, const Make& make,
                     const Context& context);

}  // namespace meshgrain
