#include "finish/rails.h"

#include <algorithm>

#include "mesh/border.h"
#include "util/triangle.h"

namespace meshgrain {

Rails::Rails(const Extraction& extraction, const FeatureLines& lines)
    : lines_(lines),
      segment_(extraction.mesh.positions.size(), no_index),
      line_(extraction.mesh.positions.size(), no_index) {
  for (const auto& [a, b, line] : extraction.line_edges) {
    put_on_line(a, line, extraction);
    put_on_line(b, line, extraction);
  }
  for (const Index v : extraction.corners) segment_[v] = stays;
  // The border of a mesh that was not made along lines.
  std::vector<Index> line_of(
      lines.vertices.empty() ? 0
                             : 1 + *std::max_element(lines.vertices.begin(), lines.vertices.end()),
      no_index);
  for (Index line = 0; line < lines.size(); ++line) {
    for (Index k = lines.begin(line); k < lines.end(line); ++k) line_of[lines.vertices[k]] = line;
  }
  for (const auto& [a, b] : rim_edges(extraction.mesh)) {
    for (const Index v : {a, b}) {
      if (!is_free(v)) continue;
      const Index node = extraction.nodes[v];
      if (node < line_of.size() && line_of[node] != no_index) {
        put_on_line(v, line_of[node], extraction);
      } else {
        segment_[v] = stays;
      }
    }
  }
}

void Rails::put_on_line(Index v, Index line, const Extraction& extraction) {
  if (line_[v] == line) return;
  if (line_[v] != no_index) {  // where pieces meet: on two lines, but at no corner
    segment_[v] = stays;
    return;
  }
  line_[v] = line;
  const Index begin = lines_.begin(line), end = lines_.end(line);
  const auto at = lines_.vertices.begin();
  const auto found = std::find(at + begin, at + end, extraction.nodes[v]);
  const Vec3& p = extraction.mesh.positions[v];
  segment_[v] = std::min(found == at + end ? begin : static_cast<Index>(found - at), end - 2);
  // A line may end where it begins, or the node may not be its own: the nearer end then.
  if (found == at + end || found == at + begin) {
    const auto distance = [&](Index segment) {
      segment_[v] = segment;
      const float d = (project(p, v) - p).norm();
      return std::pair(d, segment_[v]);
    };
    segment_[v] = std::min(distance(begin), distance(end - 2)).second;
  }
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
  if (is_free(v) || is_fixed(v)) return false;
  node = lines_.vertices[segment_[v]];
  segment_[v] = no_index;
  return true;
}

}  // namespace meshgrain
