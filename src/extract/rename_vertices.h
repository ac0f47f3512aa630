#pragma once

#include <span>

#include "meshgrain/extract.h"

namespace meshgrain {

/// Puts another vertex, or itself, in the place of each. An edge that is then on several lines
/// stays on the first of them, so that its vertices can slide there.
void rename_vertices(Extraction& extraction, std::span<const Index> becomes);

}  // namespace meshgrain
