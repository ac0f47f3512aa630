#include "finish/fit_to_rails.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "util/triangle.h"

namespace meshgrain {
namespace {

/// A point of a line. Its way is from the line's beginning; along closed lines ways go on over the
/// end, so that they grow along a chain.
struct Stop {
  double way;
  Index segment;
  Vec3 position;
};

/// Vertices of a mesh that follow each other along a line; the first and the last stay.
struct Chain {
  Index line;
  std::vector<Index> vertices;
  std::vector<Stop> stops;
};

/// Where the vertices of a chain go, by dynamic programming over a few places for each.
class Fit {
 public:
  Fit(Mesh& mesh, std::span<const LineEdge> edges, Rails& rails);

  void run();

 private:
  bool slides(Index v) const { return !rails_.is_free(v) && !rails_.is_fixed(v); }
  double length(Index line) const { return ways_[lines_.end(line) - 1]; }
  Stop stop_at(Index line, double way) const;

  /// The chain that v is in, or none if its vertices do not follow each other on the line.
  Chain chain_through(Index v) const;
  /// All vertices that come after v on one side, up to one that is fixed or to v again.
  void walk(Index v, Index next, std::vector<Index>& vertices) const;
  bool find_stops(Chain& chain) const;
  /// A closed chain begins where its edges lie well already.
  void begin_at_best(Chain& chain) const;

  /// How much of a line the chord between two of its points cuts off: the integral over the line of
  /// its squared distance from the chord beyond what is tolerated, in edge lengths.
  double cut_off(Index line, const Stop& from, const Stop& to) const;
  bool is_good(const Chain& chain) const;
  void fit(Chain& chain);

  Mesh& mesh_;
  Rails& rails_;
  const FeatureLines& lines_;
  std::vector<double> ways_;                  // of lines_.vertices
  std::vector<std::array<Index, 2>> beside_;  // the vertices before and after on its line
  std::vector<Index> line_;                   // of each vertex that slides
  std::vector<std::uint8_t> seen_;
  double edge_ = 0;  // the mean length
};

constexpr double tolerated = 0.15;  // distance of a line from its edges, in their lengths

Fit::Fit(Mesh& mesh, std::span<const LineEdge> edges, Rails& rails)
    : mesh_(mesh),
      rails_(rails),
      lines_(rails.lines()),
      ways_(lines_.vertices.size(), 0),
      beside_(mesh.positions.size(), {no_index, no_index}),
      line_(mesh.positions.size(), no_index),
      seen_(mesh.positions.size(), 0) {
  for (Index line = 0; line < lines_.size(); ++line) {
    for (Index k = lines_.begin(line) + 1; k < lines_.end(line); ++k) {
      ways_[k] = ways_[k - 1] + (lines_.positions[k] - lines_.positions[k - 1]).norm();
    }
  }
  for (const auto& [a, b, line] : edges) {
    edge_ += (mesh.positions[a] - mesh.positions[b]).norm() / static_cast<double>(edges.size());
    for (const auto& [v, w] : {std::pair(a, b), std::pair(b, a)}) {
      if (!slides(v)) continue;
      beside_[v][beside_[v][0] != no_index] = w;
      line_[v] = line;
    }
  }
}

void Fit::run() {
  for (Index v = 0; v < line_.size(); ++v) {
    if (line_[v] == no_index || beside_[v][1] == no_index || seen_[v]) continue;
    Chain chain = chain_through(v);
    for (const Index w : chain.vertices) seen_[w] = 1;
    if (!find_stops(chain) || is_good(chain)) continue;
    if (chain.vertices.front() == chain.vertices.back()) begin_at_best(chain);
    fit(chain);
  }
}

Stop Fit::stop_at(Index line, double way) const {
  const Index begin = lines_.begin(line), last = lines_.end(line) - 1;
  double here = way;
  if (lines_.is_closed(line)) here -= length(line) * std::floor(way / length(line));
  const auto above = std::upper_bound(ways_.begin() + begin + 1, ways_.begin() + last, here);
  const auto segment = static_cast<Index>(above - ways_.begin()) - 1;
  const double share =
      (here - ways_[segment]) / std::max(ways_[segment + 1] - ways_[segment], 1e-30);
  const Vec3 &a = lines_.positions[segment], &b = lines_.positions[segment + 1];
  return {way, segment, a + static_cast<float>(std::clamp(share, 0.0, 1.0)) * (b - a)};
}

void Fit::walk(Index v, Index next, std::vector<Index>& vertices) const {
  Index before = v;
  while (next != no_index && vertices.size() <= line_.size()) {
    vertices.push_back(next);
    if (next == v || line_[next] != line_[v]) return;
    const auto& [a, b] = beside_[next];
    const Index after = a == before ? b : a;
    before = std::exchange(next, after);
  }
}

Chain Fit::chain_through(Index v) const {
  Chain chain{line_[v], {}, {}};
  walk(v, beside_[v][0], chain.vertices);
  const bool closed = chain.vertices.back() == v;
  if (!closed) {
    std::reverse(chain.vertices.begin(), chain.vertices.end());
    chain.vertices.push_back(v);
    walk(v, beside_[v][1], chain.vertices);
  } else {
    chain.vertices.insert(chain.vertices.begin(), v);
  }
  return chain;
}

bool Fit::find_stops(Chain& chain) const {
  const Index begin = lines_.begin(chain.line), last = lines_.end(chain.line) - 1;
  const bool closed = lines_.is_closed(chain.line);
  const auto way = [&](Index v) {
    const Vec3& p = mesh_.positions[v];
    if (!slides(v)) return p == lines_.positions[begin] ? 0 : ways_[last];
    const Index segment = rails_.place(v);
    return ways_[segment] + (p - lines_.positions[segment]).norm();
  };
  // A vertex that stays is at an end of the line; if it is not, the next one stays as well.
  const auto is_known = [&](Index v) {
    const Vec3& p = mesh_.positions[v];
    return slides(v) || p == lines_.positions[begin] || p == lines_.positions[last];
  };
  if (!is_known(chain.vertices.back())) chain.vertices.pop_back();
  if (!is_known(chain.vertices.front())) chain.vertices.erase(chain.vertices.begin());
  const std::size_t count = chain.vertices.size();
  if (count < 3) return false;
  std::vector<double> ways(count);
  for (std::size_t i = 0; i < count; ++i) {
    ways[i] = way(chain.vertices[i]);
    if (closed && i > 0)
      ways[i] = ways[i - 1] + std::remainder(ways[i] - ways[i - 1], length(chain.line));
  }
  if (ways.back() < ways.front()) {
    std::reverse(ways.begin(), ways.end());
    std::reverse(chain.vertices.begin(), chain.vertices.end());
  }
  if (!std::is_sorted(ways.begin(), ways.end(), std::less_equal<>())) return false;
  for (const double w : ways) chain.stops.push_back(stop_at(chain.line, w));
  return true;
}

void Fit::begin_at_best(Chain& chain) const {
  const std::size_t count = chain.stops.size() - 1;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i == 0 ? count - 1 : i - 1;
    const double worse = std::max(cut_off(chain.line, chain.stops[before], chain.stops[before + 1]),
                                  cut_off(chain.line, chain.stops[i], chain.stops[i + 1]));
    if (worse < least) {
      least = worse;
      best = i;
    }
  }
  chain.vertices.pop_back();
  chain.stops.pop_back();
  std::rotate(chain.vertices.begin(), chain.vertices.begin() + best, chain.vertices.end());
  std::rotate(chain.stops.begin(), chain.stops.begin() + best, chain.stops.end());
  for (std::size_t i = count - best; i < count; ++i) chain.stops[i].way += length(chain.line);
  chain.vertices.push_back(chain.vertices[0]);
  chain.stops.push_back(stop_at(chain.line, chain.stops[0].way + length(chain.line)));
}

double Fit::cut_off(Index line, const Stop& from, const Stop& to) const {
  const Index begin = lines_.begin(line), last = lines_.end(line) - 1;
  // What the rounds of a closed line add to the ways of its points.
  double rounds = std::round((from.way - ways_[from.segment]) / length(line)) * length(line);
  if (!lines_.is_closed(line)) rounds = 0;
  double sum = 0, way_before = from.way, before = 0;
  for (Index k = from.segment + 1; ways_[k] + rounds < to.way; ++k) {
    const Vec3& p = lines_.positions[k];
    const Vec3 q = closest_point_on_segment<Vec3>(p, from.position, to.position);
    const double excess = std::max(0.0, (p - q).norm() / edge_ - tolerated);
    const double way = ways_[k] + rounds;
    sum += (before + excess * excess) / 2 * (way - way_before);
    way_before = way;
    before = excess * excess;
    if (k < last) continue;
    if (!lines_.is_closed(line)) break;
    k = begin;
    rounds += length(line);
  }
  return (sum + before / 2 * (to.way - way_before)) / edge_;
}

bool Fit::is_good(const Chain& chain) const {
  for (std::size_t i = 0; i + 1 < chain.stops.size(); ++i) {
    if (cut_off(chain.line, chain.stops[i], chain.stops[i + 1]) > 0) return false;
  }
  return true;
}

void Fit::fit(Chain& chain) {
  // Steps are shares of the way to the neighbour on that side, so that the order stays.
  constexpr std::array steps{0.0, -0.08, 0.08, -0.16, 0.16, -0.24, 0.24, -0.32, 0.32, -0.4, 0.4};
  constexpr double against_steps = 0.01, against_change = 0.01;  // of gaps between vertices
  struct Choice {
    Stop stop;
    double cost;  // of the chain up to here
    std::size_t before;
  };
  const auto& stops = chain.stops;
  const std::size_t count = stops.size();
  std::vector<std::vector<Choice>> choices(count);
  choices[0] = {{stops[0], 0, 0}};
  for (std::size_t i = 1; i < count; ++i) {
    const double gap = stops[i].way - stops[i - 1].way;
    for (const double step : steps) {
      const double next_gap = i + 1 < count ? stops[i + 1].way - stops[i].way : 0;
      const double to = stops[i].way + step * (step < 0 ? gap : next_gap);
      Choice choice{stop_at(chain.line, to), std::numeric_limits<double>::infinity(), 0};
      for (std::size_t j = 0; j < choices[i - 1].size(); ++j) {
        const Choice& from = choices[i - 1][j];
        const double change = (to - from.stop.way) / gap - 1;
        const double cost = from.cost + against_steps * step * step +
                            against_change * change * change +
                            cut_off(chain.line, from.stop, choice.stop);
        if (cost < choice.cost) {
          choice.cost = cost;
          choice.before = j;
        }
      }
      choices[i].push_back(choice);
      if (i + 1 == count) break;  // it stays
    }
  }
  for (std::size_t i = count - 1, best = choices[i][0].before; --i > 0;) {
    const Choice& choice = choices[i][best];
    mesh_.positions[chain.vertices[i]] = choice.stop.position;
    rails_.set_place(chain.vertices[i], choice.stop.segment);
    best = choice.before;
  }
}

}  // namespace

void fit_to_rails(Mesh& mesh, std::span<const LineEdge> edges, Rails& rails) {
  Fit(mesh, edges, rails).run();
}

}  // namespace meshgrain
