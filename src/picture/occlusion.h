#pragma once

#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain::picture {

/// What the pixels show, as means over their covered samples.
struct PixelBuffer {
  PixelBuffer(int width_, int height_)
      : width(width_),
        height(height_),
        colour(std::size_t(width_) * height_, Vec3::Zero()),
        normal(colour.size(), Vec3::Zero()),
        depth(colour.size(), 0.0f),
        covered(colour.size(), 0.0f) {}

  int width, height;
  std::vector<Vec3> colour, normal;
  std::vector<float> depth;    ///< Towards the eye, in pixels.
  std::vector<float> covered;  ///< Share of the pixel that the surface covers.
};

/// The share of the light from all around that reaches each pixel past what stands near it, judged
/// by what the image itself shows ("screen-space ambient occlusion"). Gives depth to folds and
/// inner corners.
std::vector<float> ambient_light(const PixelBuffer& pixels, const Context& context);

}  // namespace meshgrain::picture
