#pragma once

#include <algorithm>
#include <cmath>

#include "meshgrain/mesh.h"

// One function a shape of sample_shape(), by kind of construction.

namespace meshgrain::shapes {

Mesh plate(double resolution);  // boxes.cpp
Mesh cube(double resolution);
Mesh twisted_cube(double resolution);
Mesh fused_boxes(double resolution);

Mesh sphere(double resolution);  // round.cpp
Mesh torus(double resolution);
Mesh blob(double resolution);

Mesh cylinder(double resolution);  // turned.cpp
Mesh shaft(double resolution);

Mesh bracket(double resolution);  // bracket.cpp

Mesh three_holes(double resolution);  // implicit.cpp

/// Number of cells where there are `usual` at resolution 1.
inline int cells(double usual, double resolution, int least = 1) {
  return std::max(least, static_cast<int>(std::lround(usual * resolution)));
}

}  // namespace meshgrain::shapes
