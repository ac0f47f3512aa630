#pragma once

#include "remesh/remaking.h"

namespace meshgrain {

/// Where faces are inverted although the creases that have no room for them were left out: what
/// there is without any. That is kept, with a note, if it has clearly fewer faults.
void try_no_creases(Made& made, const RemeshOptions& options, const Make& make,
                    const Context& context);

}  // namespace meshgrain
