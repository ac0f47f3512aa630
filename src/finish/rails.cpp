#include "finish/rails.h"

#include <algorithm>
#include <utility>

#include "mesh/border.h"
#include "util/triangle.h"

namespace meshgrain {

Rails::Rails(const Extraction& extraction, const FeatureLines& lines, const Context& context)
    : lines_(lines),
      segment_(extraction.mesh.positions.size(), no_index),
      line_(extraction.mesh.positions.size(), no_index) {
  // Where each vertex of the surface is among those of the lines: of a corner, one such place.
  std::vector<Index> entry_of;
  for (Index k = 0; k < lines.vertices.size(); ++k) {
    const Index v = lines.vertices[k];
    if (v >= entry_of.size()) entry_of.resize(v + 1 + v / 8, no_index);
    if (entry_of[v] == no_index) entry_of[v] = k;
  }
  const auto entry = [&](Index v) {
    const Index node = extraction.nodes[v];
    return node < entry_of.size() ? entry_of[node] : no_index;
  };
  for (const auto& [a, b, line] : extraction.line_edges) {
    for (const Index v : {a, b}) put_on_line(v, line, entry(v), extraction.mesh.positions[v]);
  }
  for (const Index v : extraction.corners) segment_[v] = stays;
  // The border of a mesh that was not made along lines.
  for (const auto& [ends, is_border] : classified_rim(extraction.mesh, context)) {
    if (!is_border) meets_.resize(extraction.mesh.positions.size(), 0);
    for (const Index v : ends) {
      if (!is_border) meets_[v] = 1;
      if (!is_free(v)) continue;
      const Index at = entry(v);
      if (at == no_index) {
        segment_[v] = stays;
        continue;
      }
      const auto after = std::upper_bound(lines.starts.begin(), lines.starts.end(), at);
      const auto line = static_cast<Index>(after - lines.starts.begin()) - 1;
      put_on_line(v, line, at, extraction.mesh.positions[v]);
    }
  }
}

void Rails::put_on_line(Index v, Index line, Index entry, const Vec3& p) {
  if (line_[v] == line) return;
  if (line_[v] != no_index) {  // where pieces meet: on two lines, but at no corner
    segment_[v] = stays;
    return;
  }
  line_[v] = line;
  const Index begin = lines_.begin(line), end = lines_.end(line);
  if (entry > begin && entry + 1 < end) {
    segment_[v] = entry;
    return;
  }
  // At a corner, or the node is not the line's own: whichever end of the line is nearer.
  const auto distance = [&](Index segment) {
    segment_[v] = segment;
    const float d = (project(p, v) - p).norm();
    return std::pair(d, segment_[v]);
  };
  segment_[v] = std::min(distance(begin), distance(end - 2)).second;
}

Vec3 Rails::project(const Vec3& p, std::size_t v) {
  const Index line = line_[v];
  const Index begin = lines_.begin(line), last = lines_.end(line) - 2;  // segments
  const auto on_segment = [&](Index s) {
    return closest_point_on_segment<Vec3>(p, lines_.positions[s], lines_.positions[s + 1]);
  };
  Index& segment = segment_[v];
  Vec3 best = on_segment(segment);
  float least = (best - p).norm();
  // What is nearer lies within that distance of p, hence within twice of it from here; a line that
  // is not straight takes a little longer to get there.
  const float farthest = 3 * least;
  const bool closed = lines_.is_closed(line);
  const Index start = segment;
  for (const bool ahead : {true, false}) {
    Index s = start;
    for (float way = 0; way < farthest;) {
      if (s == (ahead ? last : begin)) {
        if (!closed) break;
        s = ahead ? begin : last;
      } else {
        s = ahead ? s + 1 : s - 1;
      }
      if (s == start) break;
      const Vec3 q = on_segment(s);
      if (const float d = (q - p).norm(); d < least) {
        least = d;
        best = q;
        segment = s;
      }
      way += (lines_.positions[s + 1] - lines_.positions[s]).norm();
    }
  }
  return best;
}

bool Rails::release(std::size_t v, Index& node) {
  if (!slides(v)) return false;
  node = lines_.vertices[segment_[v]];
  segment_[v] = no_index;
  return true;
}

}  // namespace meshgrain
