#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshgrain/error.h"
#include "meshgrain/picture.h"
#include "picture/occlusion.h"
#include "picture/raster.h"
#include "picture/scene.h"
#include "picture/shade.h"

namespace meshgrain {
namespace {

using namespace picture;

void check(const PictureOptions& options) {
  constexpr int most = 32768;
  if (options.width < 1 || options.height < 1 || options.width > most || options.height > most)
    throw Error(fmt::format("a picture must be 1 to {} pixels wide and high, not {} x {}", most,
                            options.width, options.height));
  if (!options.view.allFinite() || options.view.isZero(0))
    throw Error("the direction of view must not be zero");
  if (!options.up.allFinite() || options.up.isZero(0))
    throw Error("the direction that is up must not be zero");
  if (!(options.zoom > 0) || !std::isfinite(options.zoom))
    throw Error(fmt::format("the zoom must be positive, not {}", options.zoom));
}

/// Shades the samples of a band into the means of its pixels.
void resolve(const Scene& scene, const Band& band, PixelBuffer& pixels) {
  constexpr int s = supersampling;
  for (int y = 0; y < band.rows; ++y)
    for (int x = 0; x < pixels.width; ++x) {
      const std::size_t pixel = std::size_t(band.first_row + y) * pixels.width + x;
      int covered = 0;
      for (int j = y * s; j < (y + 1) * s; ++j)
        for (int i = x * s; i < (x + 1) * s; ++i) {
          const std::size_t sample = std::size_t(j) * band.sample_width + i;
          const Index item = band.item[sample];
          if (item == no_index) continue;
          const Sample seen = scene.triangles.empty()
                                  ? shade_point(scene, item, band.place(i, j))
                                  : shade_triangle(scene, item, band.place(i, j));
          ++covered;
          pixels.colour[pixel] += seen.colour;
          pixels.normal[pixel] += seen.normal;
          pixels.depth[pixel] += band.depth[sample];
        }
      if (covered == 0) continue;
      pixels.colour[pixel] /= float(covered);
      pixels.normal[pixel].stableNormalize();
      pixels.depth[pixel] /= float(covered);
      pixels.covered[pixel] = float(covered) / (s * s);
    }
}

/// A linear value in [0, 1] as a byte of the sRGB curve.
std::uint8_t encode(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * y));
}

}  // namespace

Image draw_picture(const Mesh& mesh, const PictureOptions& options, const Context& context) {
  check(options);
  const Scene scene = make_scene(mesh, options, context);
  PixelBuffer pixels(options.width, options.height);
  const Bands bands(scene, options.width, options.height, 16);
  context.for_ranges(bands.size(), 1, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (std::size_t b = begin; b < end; ++b) resolve(scene, bands.draw(b), pixels);
  });
  const std::vector<float> ambient = ambient_light(pixels, context);

  Image image{options.width, options.height, {}};
  image.rgb.resize(3 * pixels.colour.size());
  for (std::size_t i = 0; i < pixels.colour.size(); ++i) {
    const Vec3 surface = ambient[i] * pixels.colour[i];
    const Vec3 colour = surface.cwiseMin(1.0f) * pixels.covered[i] +
                        Vec3::Constant(1 - pixels.covered[i]);  // on white
    for (int k = 0; k < 3; ++k) image.rgb[3 * i + k] = encode(colour[k]);
  }
  return image;
}

}  // namespace meshgrain
