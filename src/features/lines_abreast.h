#pragma once

#include "meshgrain/features.h"

namespace meshgrain {

/// The share of the length of feature lines that another one, or another part of the same, runs
/// along no farther away than `distance`: rims of steps, grooves and thin plates.
double share_abreast(const FeatureLines& lines, double distance);

}  // namespace meshgrain
