#pragma once

#include <array>
#include <string>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Takes out what carries no surface, and joins faces that only seem not to hang together (see
/// is_torn()). Returns a line for each kind of what was done.
std::vector<std::string> clean_input(Mesh& input, const Context& context);

/// contract_border(), with a line about it if there was anything to do.
std::vector<std::string> contract_border_of(Mesh& input, std::vector<std::array<Index, 2>>& border,
                                            const Context& context);

}  // namespace meshgrain
