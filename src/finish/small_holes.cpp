#include "finish/small_holes.h"

#include <vector>

namespace meshgrain {
namespace {

struct Rim {
  bool is_small = false;
  Vec3 middle = Vec3::Zero();
};

std::vector<Rim> find_rims(const FeatureLines& lines, float longest) {
  std::vector<Rim> rims(lines.size());
  for (std::size_t line = 0; line < lines.size(); ++line) {
    if (!lines.is_closed(line)) continue;
    const Index begin = lines.begin(line), last = lines.end(line) - 1;
    float length = 0;
    for (Index k = begin; k < last; ++k) {
      length += (lines.positions[k + 1] - lines.positions[k]).norm();
      rims[line].middle += lines.positions[k];
    }
    rims[line].middle /= static_cast<float>(last - begin);
    rims[line].is_small = length < longest;
  }
  return rims;
}

}  // namespace

void open_small_holes(const Extraction& extraction, const VertexFaces& around,
                      const FeatureLines& lines, float side, Placement& placement) {
  constexpr float longest = 1, radius = 0.2f;  // sides of a face
  std::vector<Rim> rims = find_rims(lines, longest * side);
  // A piece as small as that could not be any larger.
  for (const auto& [a, b, line] : extraction.line_edges) {
    if (around[a].size() < 2 || around[b].size() < 2) rims[line].is_small = false;
  }
  for (const auto& [a, b, line] : extraction.line_edges) {
    if (!rims[line].is_small) continue;
    for (const Index v : {a, b}) {
      if (!placement.release(v)) continue;
      placement.tether(v, extraction.mesh.positions[v], extraction.nodes[v], rims[line].middle,
                       radius * side);
    }
  }
}

}  // namespace meshgrain
