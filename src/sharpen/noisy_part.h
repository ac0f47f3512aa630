#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Whether a surface is a noisy scan of a mechanical part, whose creases would be there without the
/// noise. `samples` are some of the surface and more of it, and tell most others at once.
bool is_noisy_part(const Mesh& triangles, std::span<const Mesh, 2> samples, const Context& context);

/// Takes the noise out of such a part, so that flat and round parts meet in sharp creases, and
/// returns the edges of these; none if it was no such part after all. The border stays where it is.
/// Creases shorter than `shortest` are none.
std::vector<std::array<Index, 2>> take_out_noise(Mesh& triangles, double shortest,
                                                 const Context& context);

}  // namespace meshgrain
