#pragma once

#include "meshgrain/features.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Whether corners are where they should be, or go to where the planes around them meet.
enum class Corners { stay, move };

/// Moves the vertices of lines between their corners to smooth curves through their neighbours
/// along the line, as far as no face turns over: lines of a scan go zigzag from one of its
/// triangles to the next. Vertices on the border stay.
void straighten_lines(Mesh& triangles, const FeatureLines& lines, Corners corners,
                      const Context& context);

}  // namespace meshgrain
