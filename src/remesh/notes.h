#pragma once

#include <string>
#include <vector>

#include "mesh/orient_faces.h"
#include "meshgrain/clean.h"

namespace meshgrain {

/// What was taken out of an input or turned in it, a line each, for RemeshReport::notes.
std::vector<std::string> describe(const CleanReport& cleaned);
std::vector<std::string> describe(const OrientReport& oriented);

}  // namespace meshgrain
