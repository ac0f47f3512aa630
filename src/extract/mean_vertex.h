#pragma once

#include <span>

#include "meshgrain/extract.h"

namespace meshgrain {

/// Appends a vertex half way between others; its place on the input is that of the first.
Index append_mean(Extraction& extraction, std::span<const Index> vertices);

}  // namespace meshgrain
