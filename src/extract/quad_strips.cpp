#include "extract/quad_strips.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "extract/line_edges.h"
#include "util/edge_of.h"

namespace meshgrain {

QuadStrips::QuadStrips(const Extraction& extraction)
    : mesh_(extraction.mesh),
      opposite_(mesh_.faces.corners().size(), no_index),
      hold_(held_vertices(extraction)),
      valence_(mesh_.positions.size(), 0),
      on_border_(mesh_.positions.size(), 0),
      on_branch_(mesh_.positions.size(), 0) {
  find_opposites();
  for (const Index corner : edges_) {
    for (const Index v : ends(corner)) {
      ++valence_[v];
      if (is_border(corner)) on_border_[v] = 1;
    }
  }
  for (std::size_t v = 0; v < hold_.size(); ++v) {
    if (on_border_[v] && hold_[v] == free_vertex) hold_[v] = Hold::on_line;
  }
  for (const LineEdge& edge : extraction.line_edges) line_edges_.push_back(edge_of(edge.a, edge.b));
  std::ranges::sort(line_edges_);
}

void QuadStrips::find_opposites() {
  // The edges of each vertex that is their lower end: a counting sort.
  const std::size_t corners = opposite_.size();
  std::vector<Index> offsets(mesh_.positions.size() + 1, 0), sorted(corners);
  for (Index c = 0; c < corners; ++c) ++offsets[ends(c)[0]];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  for (auto c = static_cast<Index>(corners); c-- > 0;) sorted[--offsets[ends(c)[0]]] = c;
  for (std::size_t v = 0; v + 1 < offsets.size(); ++v) {
    const auto begin = sorted.begin() + offsets[v], end = sorted.begin() + offsets[v + 1];
    std::stable_sort(begin, end, [&](Index a, Index b) { return ends(a)[1] < ends(b)[1]; });
    for (auto it = begin; it != end;) {
      const auto next = std::find_if(it, end, [&](Index c) { return ends(c) != ends(*it); });
      edges_.push_back(*it);
      if (next - it > 2) {
        for (const Index w : ends(*it)) on_branch_[w] = 1;
      }
      if (next - it > 1) {
        opposite_[it[0]] = it[1];
        opposite_[it[1]] = it[0];
      }
      it = next;
    }
  }
}

QuadStrips::Edge QuadStrips::ends(Index corner) const {
  const auto corners = mesh_.faces.corners();
  return edge_of(corners[corner], corners[corner % 4 == 3 ? corner - 3 : corner + 1]);
}

bool QuadStrips::on_line(const Edge& edge) const {
  return std::ranges::binary_search(line_edges_, edge);
}

QuadStrip QuadStrips::follow(Index start) const {
  QuadStrip strip;
  // Returns whether the strip goes around.
  const auto walk = [&](Index corner) {
    while (corner != no_index) {
      strip.faces.push_back(corner / 4);
      const Index beyond = corner / 4 * 4 + (corner + 2) % 4;
      if (beyond == start || opposite_[beyond] == start) return true;
      strip.rungs.push_back(beyond);
      corner = opposite_[beyond];
    }
    return false;
  };
  strip.rungs.push_back(start);
  if (!walk(start)) walk(opposite_[start]);
  strip.narrowest = std::numeric_limits<float>::infinity();
  for (const Index rung : strip.rungs) {
    const auto [a, b] = ends(rung);
    const float length = (mesh_.positions[a] - mesh_.positions[b]).norm();
    strip.width += length;
    strip.narrowest = std::min(strip.narrowest, length);
  }
  strip.width /= static_cast<float>(strip.rungs.size());
  return strip;
}

std::vector<QuadStrip> QuadStrips::up_to(std::size_t most) const {
  std::vector<QuadStrip> strips;
  std::vector<std::uint8_t> seen(opposite_.size(), 0);
  for (const Index edge : edges_) {
    if (seen[edge]) continue;
    QuadStrip strip = follow(edge);
    for (const Index rung : strip.rungs) {
      seen[rung] = 1;
      if (!is_border(rung)) seen[opposite_[rung]] = 1;
    }
    const bool branches = std::ranges::any_of(strip.rungs, [&](Index rung) {
      const auto [a, b] = ends(rung);
      return on_branch_[a] && on_branch_[b];
    });
    if (strip.faces.size() <= most && !branches) strips.push_back(std::move(strip));
  }
  std::ranges::stable_sort(strips, {}, &QuadStrip::width);
  return strips;
}

}  // namespace meshgrain
