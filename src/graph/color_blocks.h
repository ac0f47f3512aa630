#pragma once

#include "meshgrain/hierarchy.h"

namespace meshgrain {

BlockColoring color_blocks(const Graph& graph, const Context& context);

}  // namespace meshgrain
