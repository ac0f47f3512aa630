#pragma once

#include "remesh/remaking.h"

namespace meshgrain {

/// Where a surface is not manifold its pieces get the same vertices, which may leave faces no room:
/// then they are left apart if that has clearly fewer faults.
void try_pieces_apart(Made& made, const RemeshOptions& options, const Make& make,
                      const Context& context);

}  // namespace meshgrain
