#include "finish/rails.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/border.h"
#include "util/triangle.h"

namespace meshgrain {

Rails::Rails(const Extraction& extraction, const FeatureLines& lines)
    : lines_(lines),
      segment_(extraction.mesh.positions.size(), no_index),
      line_(extraction.mesh.positions.size(), no_index) {
  ways_.resize(lines.vertices.size(), 0);
  for (Index line = 0; line < lines.size(); ++line) {
    for (Index k = lines.begin(line) + 1; k < lines.end(line); ++k) {
      ways_[k] = ways_[k - 1] + (lines.positions[k] - lines.positions[k - 1]).norm();
    }
  }
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
  for (const auto& [a, b] : rim_edges(extraction.mesh)) {
    for (const Index v : {a, b}) {
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

double Rails::way(Index v, const Mesh& mesh, Index line, double from) const {
  const Index begin = lines_.begin(line), last = lines_.end(line) - 1;
  const double length = ways_[last];
  if (is_fixed(v)) {
    const Vec3& p = mesh.positions[v];
    const float to_begin = (p - lines_.positions[begin]).norm();
    const float to_end = (p - lines_.positions[last]).norm();
    if (to_begin == to_end) return from < length / 2 ? 0 : length;
    return to_begin < to_end ? 0 : length;
  }
  const double result =
      ways_[segment_[v]] + (mesh.positions[v] - lines_.positions[segment_[v]]).norm();
  return lines_.is_closed(line) ? from + std::remainder(result - from, length) : result;
}

Vec3 Rails::at(Index line, double way, Index& segment) const {
  const Index begin = lines_.begin(line), last = lines_.end(line) - 1;
  const double length = ways_[last];
  if (lines_.is_closed(line)) way -= length * std::floor(way / length);
  const auto above = std::upper_bound(ways_.begin() + begin + 1, ways_.begin() + last, way);
  segment = static_cast<Index>(above - ways_.begin()) - 1;
  const double share =
      (way - ways_[segment]) / std::max(ways_[segment + 1] - ways_[segment], 1e-30);
  const Vec3 &a = lines_.positions[segment], &b = lines_.positions[segment + 1];
  return a + static_cast<float>(std::clamp(share, 0.0, 1.0)) * (b - a);
}

float Rails::cut_off(Index line, const std::array<double, 3>& ways,
                     const std::array<Vec3, 3>& points) const {
  float farthest = 0;
  Index segment = 0;
  at(line, ways[0], segment);
  const Index begin = lines_.begin(line), last = lines_.end(line) - 1;
  const double length = ways_[last];
  const double rounds = lines_.is_closed(line) ? (ways[0] - ways_[segment]) / length : 0;
  double turn = std::round(rounds) * length;
  for (Index k = segment + 1;; ++k) {
    if (k > last) {
      k = begin;
      turn += length;
    }
    const double way = ways_[k] + turn;
    if (way >= ways[2] || way > ways[0] + length) return farthest;
    const int half = way < ways[1] ? 0 : 1;
    const Vec3& p = lines_.positions[k];
    const Vec3 q = closest_point_on_segment<Vec3>(p, points[half], points[half + 1]);
    farthest = std::max(farthest, (p - q).norm());
  }
}

void Rails::fit(Mesh& mesh, std::span<const LineEdge> edges) {
  std::vector<std::array<Index, 2>> beside(segment_.size(), {no_index, no_index});
  double total = 0;
  for (const auto& [a, b, line] : edges) {
    total += (mesh.positions[a] - mesh.positions[b]).norm();
    for (const auto& [v, w] : {std::pair(a, b), std::pair(b, a)}) {
      if (!is_free(v) && !is_fixed(v)) beside[v][beside[v][0] != no_index] = w;
    }
  }
  const auto edge =
      static_cast<float>(total / static_cast<double>(std::max<std::size_t>(edges.size(), 1)));
  const float tolerated = 0.06f * edge;
  std::vector<Index> between;  // two others of their line
  for (Index v = 0; v < beside.size(); ++v) {
    if (beside[v][1] != no_index && !is_free(beside[v][0]) && !is_free(beside[v][1])) {
      between.push_back(v);
    }
  }
  constexpr int sweeps = 3;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const Index v : between) fit_between(v, beside[v], tolerated, mesh);
  }
}

void Rails::fit_between(Index v, std::array<Index, 2> ends, float tolerated, Mesh& mesh) {
  const Index line = line_[v];
  const double own = way(v, mesh, line, 0);
  std::array<double, 2> ways{way(ends[0], mesh, line, own), way(ends[1], mesh, line, own)};
  if (ways[0] > ways[1]) {
    std::swap(ends[0], ends[1]);
    std::swap(ways[0], ways[1]);
  }
  if (!(ways[0] < own && own < ways[1])) return;
  const auto cost = [&](double to, const Vec3& p) {
    return cut_off(line, {ways[0], to, ways[1]},
                   {mesh.positions[ends[0]], p, mesh.positions[ends[1]]});
  };
  float least = cost(own, mesh.positions[v]);
  if (least < tolerated) return;
  least -= tolerated / 3;  // what it must gain
  Vec3 best = mesh.positions[v];
  for (const double step : {-0.3, -0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.3}) {
    const double to = own + step * (step < 0 ? own - ways[0] : ways[1] - own);
    Index segment = 0;
    const Vec3 p = at(line, to, segment);
    const float c = cost(to, p);
    if (c >= least) continue;
    least = c;
    best = p;
    segment_[v] = segment;
  }
  mesh.positions[v] = best;
}

bool Rails::release(std::size_t v, Index& node) {
  if (is_free(v) || is_fixed(v)) return false;
  node = lines_.vertices[segment_[v]];
  segment_[v] = no_index;
  return true;
}

}  // namespace meshgrain
