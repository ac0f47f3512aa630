#include "finish/chords.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "util/triangle.h"

namespace meshgrain {
namespace {

// Distance of a line from its edges, in their lengths: on a circle, edges of half its radius leave
// it by that.
constexpr double tolerated = 0.06;
// What vertices begin to slide away from while faces are smoothed: earlier, as the faces draw them
// back.
constexpr double far = 0.045;

}  // namespace

Chords::Chords(const Mesh& mesh, std::span<const LineEdge> edges, const Rails& rails)
    : mesh_(mesh),
      rails_(rails),
      ways_(rails.lines().vertices.size(), 0),
      beside_(mesh.positions.size(), {no_index, no_index}),
      line_(mesh.positions.size(), no_index),
      goes_around_(mesh.positions.size(), 0),
      faces_beside_(mesh.positions.size(), 0) {
  for (Index line = 0; line < lines().size(); ++line) {
    for (Index k = lines().begin(line) + 1; k < lines().end(line); ++k) {
      ways_[k] = ways_[k - 1] + (lines().positions[k] - lines().positions[k - 1]).norm();
    }
  }
  for (const auto& [a, b, line] : edges) {
    edge_ += (mesh.positions[a] - mesh.positions[b]).norm() / static_cast<double>(edges.size());
    for (const auto& [v, w] : {std::pair(a, b), std::pair(b, a)}) {
      if (!rails_.slides(v)) continue;
      beside_[v][beside_[v][0] != no_index] = w;
      line_[v] = line;
    }
  }
  if (edges.empty()) return;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index v = face[k], next = face[k + 1 < face.size() ? k + 1 : 0];
      if (std::ranges::find(beside_[v], next) != beside_[v].end()) ++faces_beside_[v];
    }
  }
}

std::optional<double> Chords::way(Index v, const Vec3& p, Index line, double near) const {
  const auto nearest = [&](double way) {
    if (!lines().is_closed(line)) return way;
    return near + std::remainder(way - near, length(line));
  };
  if (rails_.slides(v)) {
    const Index segment = rails_.place(v);
    return nearest(ways_[segment] + (p - lines().positions[segment]).norm());
  }
  std::optional<double> best;
  for (const Index end : {lines().begin(line), lines().end(line) - 1}) {
    if (p != lines().positions[end]) continue;
    const double way = nearest(ways_[end]);
    if (!best || std::abs(way - near) < std::abs(*best - near)) best = way;
  }
  return best;
}

Chords::Stop Chords::stop_at(Index line, double way) const {
  const Index begin = lines().begin(line), last = lines().end(line) - 1;
  double here = way;
  if (lines().is_closed(line)) here -= length(line) * std::floor(way / length(line));
  const auto above = std::upper_bound(ways_.begin() + begin + 1, ways_.begin() + last, here);
  const auto segment = static_cast<Index>(above - ways_.begin()) - 1;
  const double share =
      (here - ways_[segment]) / std::max(ways_[segment + 1] - ways_[segment], 1e-30);
  const Vec3 &a = lines().positions[segment], &b = lines().positions[segment + 1];
  return {way, segment, a + static_cast<float>(std::clamp(share, 0.0, 1.0)) * (b - a)};
}

void Chords::set_order(std::span<const Index> around) {
  const std::size_t count = around.size();
  for (std::size_t i = 0; i < count; ++i) {
    beside_[around[i]] = {around[(i + count - 1) % count], around[(i + 1) % count]};
    goes_around_[around[i]] = 1;
  }
}

void Chords::note_ways(const Context& context) {
  noted_.resize(line_.size());
  noted_slides_.resize(line_.size());
  constexpr std::size_t grain = 1024;
  context.for_ranges(line_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      noted_slides_[v] = line_[v] != no_index && rails_.slides(v);
      if (noted_slides_[v]) noted_[v] = *way(v, line_[v], 0);
    }
  });
}

Chords::Ways Chords::ways_beside(Index v) const {
  const Index line = line_[v];
  const double from = noted_[v];
  Ways result;
  for (const int k : {0, 1}) {
    const Index w = beside_[v][k];
    if (w == no_index) continue;
    // As it was noted: vertices beside v move at the same time.
    const bool slides = line_[w] == line && noted_slides_[w];
    if (!slides) {
      result[k] = way(w, line, from);
    } else if (goes_around_[v]) {
      const double period = length(line), ahead = (noted_[w] - from) / period;
      result[k] = from + period * (ahead - (k == 0 ? std::ceil(ahead) : std::floor(ahead)));
    } else {
      result[k] = noted_[w];
    }
  }
  return result;
}

std::optional<Chords::Stop> Chords::slide(Index v, const Vec3& p) const {
  const Index line = line_[v];
  if (line == no_index) return std::nullopt;
  const auto beside = ways_beside(v);
  auto [before, after] = beside;
  if (!before || !after) return std::nullopt;
  if (*before > *after) std::swap(before, after);
  const double from = noted_[v];
  if (from < *before || from > *after) return std::nullopt;
  const double to = *way(v, p, line, from);
  double evenly = 0;
  if (goes_around_[v]) {
    constexpr double large = 0.25, strongly = 8;
    const double share = std::max(*after - from, from - *before) / length(line);
    evenly = std::clamp(strongly * (share - large), 0.0, 1.0);
  }
  double drawn = to + evenly * ((*before + *after) / 2 - to);
  if (may_lie_far(v, beside)) drawn = balance(line, *before, from, *after, drawn);
  return stop_at(line, std::clamp(drawn, (*before + from) / 2, (from + *after) / 2));
}

bool Chords::may_lie_far(Index v, const Ways& ways) const {
  constexpr int beside_crease = 2;
  if (faces_beside_[v] != beside_crease) return false;
  for (const int k : {0, 1}) {
    // No curve of that length gets farther from its chord than the ellipse around the ends.
    const double way = *ways[k] - noted_[v];
    const double chord = (mesh_.positions[beside_[v][k]] - mesh_.positions[v]).squaredNorm();
    if (way * way - chord > 4 * far * far * edge_ * edge_) return true;
  }
  return false;
}

double Chords::balance(Index line, double before, double here, double after, double to) const {
  constexpr double too_far = 0.07, least = 0.02, tiny = 1e-30;
  const double behind = depth(line, before, here), ahead = depth(line, here, after);
  const double excess = (std::max(behind, ahead) - far) / (too_far - far);
  if (!(excess > 0)) return to;
  // Depths are as the squares of lengths.
  const double turn_behind = std::sqrt(std::max(behind, least)) / std::max(here - before, tiny);
  const double turn_ahead = std::sqrt(std::max(ahead, least)) / std::max(after - here, tiny);
  const double balanced = before + (after - before) * turn_ahead / (turn_behind + turn_ahead);
  return to + std::min(excess, 1.0) * (balanced - to);
}

double Chords::depth(Index line, double from, double to) const {
  const Vec3 begin = stop_at(line, from).position, end = stop_at(line, to).position;
  const auto offset = [&](double share) -> Vec3 {
    const Vec3 p = stop_at(line, from + share * (to - from)).position;
    return p - closest_point_on_segment<Vec3>(p, begin, end);
  };
  const Vec3 middle = offset(0.5);
  const float depth = middle.norm();
  if (!(depth > 0)) return 0;
  // A circle is there by 8 / 9 of that.
  const float beside = std::min(offset(1.0 / 3).dot(middle), offset(2.0 / 3).dot(middle)) / depth;
  return std::clamp(9.0f / 8 * beside, 0.0f, depth) / edge_;
}

double Chords::cut_off(Index line, const Stop& from, const Stop& to) const {
  const Index begin = lines().begin(line), last = lines().end(line) - 1;
  // What the rounds of a closed line add to the ways of its points.
  double rounds = std::round((from.way - ways_[from.segment]) / length(line)) * length(line);
  if (!lines().is_closed(line)) rounds = 0;
  double sum = 0, way_before = from.way, before = 0;
  for (Index k = from.segment + 1; ways_[k] + rounds < to.way; ++k) {
    const Vec3& p = lines().positions[k];
    const Vec3 q = closest_point_on_segment<Vec3>(p, from.position, to.position);
    const double excess = std::max(0.0, (p - q).norm() / edge_ - tolerated);
    const double way = ways_[k] + rounds;
    sum += (before + excess * excess) / 2 * (way - way_before);
    way_before = way;
    before = excess * excess;
    if (k < last) continue;
    if (!lines().is_closed(line)) break;
    k = begin;
    rounds += length(line);
  }
  return (sum + before / 2 * (to.way - way_before)) / edge_;
}

double Chords::cut_off(Index v) const {
  constexpr double of_fold = 1;  // what is left uncovered where both edges go the same way
  const Index line = line_[v];
  if (line == no_index || !rails_.slides(v)) return 0;
  const double here = *way(v, line, 0);
  const Stop at = stop_at(line, here);
  double sum = 0;
  int ahead = 0, back = 0;
  for (const Index w : beside_[v]) {
    if (w == no_index) continue;
    const std::optional<double> there = way(w, line, here);
    if (!there) continue;
    const Stop other = stop_at(line, *there);
    const bool is_back = *there < here;
    sum += is_back ? cut_off(line, other, at) : cut_off(line, at, other);
    ++(is_back ? back : ahead);
  }
  return std::max(ahead, back) > 1 ? sum + of_fold : sum;
}

}  // namespace meshgrain
