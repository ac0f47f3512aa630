#pragma once

#include "remesh/remaking.h"

namespace meshgrain {

/// Where faces are inverted over a surface that is manifold and does not pass through itself, such
/// as a lattice of struts thinner than they are: what there is with two or four times as many. That
/// is kept, with a note, if none is inverted any more, as validity comes before the count.
void try_more_faces(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context);

}  // namespace meshgrain
