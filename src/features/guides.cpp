#include "meshgrain/guides.h"

namespace meshgrain {

std::vector<Guide> guides_of(const Polylines& lines, float strength) {
  std::vector<Guide> guides;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    Guide& guide = guides.emplace_back();
    guide.strength = strength;
    for (Index k = lines.begin(line); k < lines.end(line); ++k) {
      guide.points.push_back(lines.points[lines.vertices[k]]);
    }
    guide.closed = lines.vertices[lines.begin(line)] == lines.vertices[lines.end(line) - 1];
    if (guide.closed) guide.points.pop_back();
  }
  return guides;
}

}  // namespace meshgrain
