#include "picture/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace meshgrain::picture {

std::vector<float> ambient_light(const PixelBuffer& pixels, const Context& context) {
  constexpr int taps = 20, turns = 4;
  constexpr float strength = 2.0f;
  const float reach = 0.07f * float(std::min(pixels.width, pixels.height));
  // Taps along a spiral that gets denser inwards. Neighbouring pixels turn it differently, and the
  // mean over 4 x 4 pixels below then sees sixteen times as many.
  std::array<std::array<Eigen::Vector2f, taps>, turns * turns> spiral;
  for (int turn = 0; turn < turns * turns; ++turn)
    for (int k = 0; k < taps; ++k) {
      const float share = (float(k) + 0.5f + float(turn) / (turns * turns) - 0.5f) / taps;
      const float angle =
          2.39996f * float(k) + 2 * std::numbers::pi_v<float> * float(turn * 7 % 16) / 16;
      spiral[turn][k] =
          (1 + reach * share * share) * Eigen::Vector2f(std::cos(angle), std::sin(angle));
    }

  const auto index = [&](int x, int y) { return std::size_t(y) * pixels.width + x; };
  std::vector<float> raw(pixels.depth.size(), 1.0f);
  context.for_ranges(pixels.height, 8, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < pixels.width; ++x) {
        const std::size_t here = index(x, y);
        if (pixels.covered[here] == 0) continue;
        float blocked = 0;
        for (const Eigen::Vector2f& tap : spiral[(y % turns) * turns + x % turns]) {
          const int tx = x + int(std::lround(tap.x())), ty = y + int(std::lround(tap.y()));
          if (tx < 0 || ty < 0 || tx >= pixels.width || ty >= pixels.height) continue;
          const std::size_t there = index(tx, ty);
          if (pixels.covered[there] == 0) continue;
          const Vec3 d(float(tx - x), float(ty - y), pixels.depth[there] - pixels.depth[here]);
          const float length = d.norm();
          const float sine = pixels.normal[here].dot(d) / std::max(length, 1e-6f);
          const float far = length / reach;  // what is far off in depth blocks nothing
          blocked += std::max(0.0f, sine - 0.12f) / (1 + far * far);
        }
        raw[here] = std::clamp(1 - strength * blocked / taps, 0.25f, 1.0f);
      }
  });

  std::vector<float> light(raw.size(), 1.0f);
  context.for_ranges(pixels.height, 8, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < pixels.width; ++x) {
        const std::size_t here = index(x, y);
        if (pixels.covered[here] == 0) continue;
        float sum = 0, weight = 0;
        for (int ty = std::max(0, y - 1); ty <= std::min(pixels.height - 1, y + 2); ++ty)
          for (int tx = std::max(0, x - 1); tx <= std::min(pixels.width - 1, x + 2); ++tx) {
            const std::size_t there = index(tx, ty);
            if (pixels.covered[there] == 0) continue;
            if (pixels.normal[there].dot(pixels.normal[here]) < 0.8f) continue;  // across a crease
            sum += raw[there];
            weight += 1;
          }
        light[here] = weight > 0 ? sum / weight : raw[here];
      }
  });
  return light;
}

}  // namespace meshgrain::picture
