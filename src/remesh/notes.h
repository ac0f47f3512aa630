#pragma once

#include <string>
#include <vector>

#include "meshgrain/clean.h"

namespace meshgrain {

/// What was taken out of an input, a line each, for RemeshReport::notes.
std::vector<std::string> describe(const CleanReport& cleaned);

}  // namespace meshgrain
