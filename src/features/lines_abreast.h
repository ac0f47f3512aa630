#pragma once

#include <cstdint>
#include <span>

#include "meshgrain/features.h"

namespace meshgrain {

/// The share of the length of feature lines that are creases along which another one, or another
/// part of the same, runs no farther away than `distance`: rims of steps, grooves and thin plates.
/// `on_border`: a flag a vertex of the surface, to tell borders from creases; without any, all are
/// creases.
double share_abreast(const FeatureLines& lines, std::span<const std::uint8_t> on_border,
                     double distance);

}  // namespace meshgrain
