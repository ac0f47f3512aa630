#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "meshgrain/surface.h"

namespace meshgrain {

/// surface_area() and edge_lengths(), found together.
struct SurfaceSize {
  double area;
  EdgeLengths edges;
};
SurfaceSize surface_size(const Mesh& mesh, const Context& context);

}  // namespace meshgrain
