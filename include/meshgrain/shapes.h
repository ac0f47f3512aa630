#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The names that sample_shape knows, in the order in which they are listed to the user.
std::vector<std::string> sample_names();

/// A made shape for demonstrations and tests: closed and oriented outwards unless its name says
/// otherwise. `resolution` scales the number of vertices along a side (1 = the usual density).
/// Throws Error for an unknown name.
Mesh sample_shape(std::string_view name, double resolution = 1);

}  // namespace meshgrain
