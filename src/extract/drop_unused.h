#pragma once

#include "meshgrain/extract.h"

namespace meshgrain {

/// Keeps the vertices that faces use, in their order.
void drop_unused(Extraction& extraction);

}  // namespace meshgrain
