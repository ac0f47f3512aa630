#pragma once

#include <cstdint>
#include <vector>

#include "picture/scene.h"

namespace meshgrain::picture {

/// Samples along each side of a pixel.
inline constexpr int supersampling = 3;

/// The foremost triangle (or point of a cloud) at every sample of a band of pixel rows.
struct Band {
  int first_row = 0, rows = 0;  ///< In pixels.
  int sample_width = 0;
  std::vector<float> depth;
  std::vector<Index> item;  ///< Index of the triangle or point; no_index where nothing is.

  /// Where sample (i, j) of the band lies in the image, in pixels.
  Eigen::Vector2f place(int i, int j) const {
    return {(float(i) + 0.5f) / supersampling,
            float(first_row) + (float(j) + 0.5f) / supersampling};
  }
};

/// Which triangles (or points) touch which band of `rows` pixel rows.
class Bands {
 public:
  Bands(const Scene& scene, int width, int height, int rows);
  std::size_t size() const { return end_.size() - 1; }
  /// Finds what is foremost in band `b`.
  Band draw(std::size_t b) const;

 private:
  const Scene& scene_;
  int width_, height_, rows_;
  std::vector<Index> items_;      // band after band
  std::vector<std::size_t> end_;  // of each band, after a 0
};

}  // namespace meshgrain::picture
