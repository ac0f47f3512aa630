#pragma once

#include "meshgrain/remesh.h"

namespace meshgrain {

/// remesh() with RemeshOptions::symmetry: of one half of the input, whose mirror image is added.
RemeshResult remesh_symmetric(Mesh input, RemeshOptions options, const Context& context);

}  // namespace meshgrain
