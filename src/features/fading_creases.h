#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/border.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Follows creases beyond their ends, where they become flat little by little: as a clean line that
/// goes straight on, each edge nearly as sharp as the one before, and all others there much
/// flatter. `is_crease`: a flag for each of `edges`, which are all that are not flat.
void follow_fading_creases(const Mesh& triangles, std::span<const SharpEdge> edges,
                           std::vector<std::uint8_t>& is_crease);

}  // namespace meshgrain
