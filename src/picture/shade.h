#pragma once

#include "picture/scene.h"

namespace meshgrain::picture {

/// What one sample shows. Colours are linear (not gamma encoded).
struct Sample {
  Vec3 colour;
  Vec3 normal;  ///< Towards the eye.
};

/// Colours the place (x, y) of a triangle: light, then tints, edges and dots, all from the corners
/// of its own face, so that no line can show through from behind.
Sample shade_triangle(const Scene& scene, Index triangle, const Eigen::Vector2f& place);

/// Colours the place (x, y) of a point of a cloud.
Sample shade_point(const Scene& scene, Index point, const Eigen::Vector2f& place);

}  // namespace meshgrain::picture
