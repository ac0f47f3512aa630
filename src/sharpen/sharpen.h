#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// What had hidden the creases of a mechanical part.
enum class Blur { none, noise, chamfers };

/// If a surface is a mechanical part whose creases are not to be seen, as noise of a scan covers
/// them, or as the grid that it was sampled on has cut them off, makes them sharp again, marks
/// their edges, and says so. Else leaves it as it is. The border stays where it is.
/// `edge_length` is that of the output: shorter creases are none.
Blur sharpen(Mesh& triangles, double edge_length, const Context& context);

}  // namespace meshgrain
