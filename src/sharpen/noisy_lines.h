#pragma once

#include "meshgrain/features.h"

namespace meshgrain {

/// The marked edges of a noisy surface as lines between corners, of which only the sharpest within
/// `arm` counts: such lines turn sharply again and again.
FeatureLines noisy_lines(const Mesh& triangles, double arm);

}  // namespace meshgrain
