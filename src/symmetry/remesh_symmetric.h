#pragma once

#include <functional>

#include "meshgrain/remesh.h"
#include "remesh/flaws.h"

namespace meshgrain {

/// What a mesh becomes that need not be symmetric.
struct RemeshedHalf {
  RemeshResult result;
  FaultCounts faults;
};
using RemeshHalf = std::function<RemeshedHalf(Mesh, const RemeshOptions&, const Context&)>;

/// remesh() with RemeshOptions::symmetry: of one half of the input, whose mirror image is added.
RemeshResult remesh_symmetric(Mesh input, RemeshOptions options, const RemeshHalf& remesh_half,
                              const Context& context);

}  // namespace meshgrain
