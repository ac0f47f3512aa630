#pragma once

#include <string>
#include <vector>

#include "meshgrain/clean.h"

namespace meshgrain {

/// What was taken out of an input, a line each, for RemeshReport::notes.
std::vector<std::string> describe(const CleanReport& cleaned);

inline constexpr const char* sharpened_note =
    "a noisy scan of a mechanical part: its noise was taken out to make its creases sharp";

}  // namespace meshgrain
