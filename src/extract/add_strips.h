#pragma once

#include "meshgrain/extract.h"

namespace meshgrain {

/// Cuts whole strips of a mesh of quads in two along their middle: the opposite of remove_strips().
/// No vertex becomes irregular, and neither topology nor features change. Does so until there are
/// `least` to `most` faces more, those strips first that are widest where they are narrowest.
/// Returns how many there are.
std::size_t add_strips(Extraction& extraction, std::size_t least, std::size_t most,
                       const Context& context);

}  // namespace meshgrain
