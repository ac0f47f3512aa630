#pragma once

#include "meshgrain/extract.h"

namespace meshgrain {

/// Takes whole strips out of a mesh of quads: rows of quads across opposite edges, from border to
/// border or around. What was on both sides then meets, and no vertex becomes irregular that was
/// not: a grid stays a grid. Features stay, and so does the topology. Does so until `least` to
/// `most` faces are gone, the narrowest strips first, or no strip is left that may go, as none may
/// where edges have more than two faces. Returns how many faces it took.
std::size_t remove_strips(Extraction& extraction, std::size_t least, std::size_t most,
                          const Context& context);

}  // namespace meshgrain
