#pragma once

#include "remesh/remaking.h"

namespace meshgrain {

/// Where faces are inverted that follow creases which nobody asked for: what there is without any.
/// That is kept, with a note, if it has clearly fewer faults.
void try_no_creases(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context);

}  // namespace meshgrain
