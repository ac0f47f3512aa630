#pragma once

#include <functional>

#include "meshgrain/remesh.h"

namespace meshgrain {

/// How a mesh is remeshed that need not become symmetric.
using RemeshHalf = std::function<RemeshResult(Mesh, const RemeshOptions&, const Context&)>;

/// remesh() with RemeshOptions::symmetry: of one half of the input, whose mirror image is added.
RemeshResult remesh_symmetric(Mesh input, RemeshOptions options, const RemeshHalf& remesh_half,
                              const Context& context);

}  // namespace meshgrain
