#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// If a surface is a noisy scan of a mechanical part, takes out the noise, so that flat and round
/// parts meet in sharp creases, marks the edges of these, and returns true. Else leaves it as it
/// is. The border stays where it is. `edge_length` is that of the output: shorter creases are none.
bool sharpen_noisy_part(Mesh& triangles, double edge_length, const Context& context);

}  // namespace meshgrain
