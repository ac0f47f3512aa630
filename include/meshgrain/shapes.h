#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The names that sample_shape knows, in the order in which they are listed to the user.
std::vector<std::string> sample_names();

/// A made shape for demonstrations and tests: triangles, closed and oriented outwards, about the
/// origin, with every crease on mesh edges (only `plate` is open). `resolution` scales the number
/// of vertices along a side (1 = the usual density, between 0.1 and 500). The Euler number is in
/// brackets.
///
///     bracket       L-shaped bracket with a fillet, a rounded end and a round hole [0]
///     cube          unit cube [2]
///     twisted-cube  unit cube twisted by a quarter turn about its upright axis [2]
///     fused-boxes   a box on another one, tilted by 30 degrees [2]
///     cylinder      as wide as it is high, with flat caps [2]
///     shaft         turned part of cylinders of different radii [2]
///     sphere        unit geodesic sphere [2]
///     torus         radii 1 and 0.4 [0]
///     three-holes   smooth surface of genus three [-4]
///     blob          sphere with soft bumps and dents [2]
///     plate         flat unit square with a border, facing +z [1]
///
/// Throws Error for an unknown name, and for a resolution out of range or too coarse for the shape.
Mesh sample_shape(std::string_view name, double resolution = 1);

/// Moves every vertex by `share` of the mean edge length, each in a direction of its own, as a scan
/// would. The same noise each time.
void add_noise(Mesh& mesh, double share);

}  // namespace meshgrain
