#include "features/lines_abreast.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "features/line_samples.h"

namespace meshgrain {

double share_abreast(const FeatureLines& lines, std::span<const std::uint8_t> on_border,
                     double distance) {
  constexpr double step = 0.2;    // between samples, of the distance
  constexpr double alike = 0.9;   // cosine of two directions
  constexpr double across = 0.3;  // of the way from one to the other and the line, at most
  if (!(distance > 0)) return 0;
  LineSamples places(distance);
  std::vector<LineSamples::Sample> samples;  // of creases
  std::size_t all = 0;
  for (Index line = 0; line < lines.size(); ++line) {
    double next = 0;  // from the segment's start to the next sample
    for (Index k = lines.begin(line); k + 1 < lines.end(line); ++k) {
      const Eigen::Vector3d from = lines.positions[k].cast<double>();
      const Eigen::Vector3d along = lines.positions[k + 1].cast<double>() - from;
      const double length = along.norm();
      const bool is_border =
          !on_border.empty() && on_border[lines.vertices[k]] && on_border[lines.vertices[k + 1]];
      for (; next < length; next += step * distance) {
        ++all;
        if (is_border) continue;
        samples.push_back({from + (next / length) * along, along / length, Eigen::Vector3d::Zero(),
                           line, static_cast<Index>(samples.size())});
        places.add(samples.back());
      }
      next -= length;
    }
  }
  std::size_t count = 0;
  for (const LineSamples::Sample& sample : samples) {
    bool found = false;
    places.for_near(sample.position, distance, [&](const LineSamples::Sample& other, double gap) {
      const double ahead = (other.position - sample.position).dot(sample.direction);
      found = found || (gap > 0 && std::abs(ahead) < across * gap &&
                        std::abs(sample.direction.dot(other.direction)) > alike);
    });
    count += found;
  }
  return all == 0 ? 0 : static_cast<double>(count) / static_cast<double>(all);
}

}  // namespace meshgrain
