#include "finish/go_around.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "finish/chains.h"

namespace meshgrain {
namespace {

constexpr double widest = 0.4;  // of the line: the straight way must not be on the other side

/// Whether the vertices of a closed chain follow each other once around, none from far behind.
bool goes_around(const Chain& chain, double length) {
  for (std::size_t i = 0; i + 1 < chain.stops.size(); ++i) {
    if (chain.stops[i + 1].way - chain.stops[i].way > widest * length) return false;
  }
  return std::abs(chain.stops.back().way - chain.stops.front().way - length) < 0.01 * length;
}

/// Vertices of a closed line, once around.
class Spread {
 public:
  Spread(Mesh& mesh, const Chords& chords, Rails& rails, const Chain& chain)
      : mesh_(mesh),
        chords_(chords),
        rails_(rails),
        line_(chain.line),
        vertices_(chain.vertices.begin(), chain.vertices.end() - 1) {
    for (const Index v : vertices_) start_.push_back(chords.way(v, line_, 0).value_or(0));
  }

  const std::vector<Index>& vertices() const { return vertices_; }

  void reverse() {
    std::reverse(vertices_.begin(), vertices_.end());
    std::reverse(start_.begin(), start_.end());
  }

  /// Puts vertices right that are out of order only among their neighbours, as where a large hole
  /// is ragged. Returns false if they do not come once around.
  bool put_in_order() {
    const double rounds = rounds_of(start_);
    if (std::abs(std::abs(rounds) - 1) > 0.01) return false;
    if (rounds < 0) reverse();
    begin_at_best();
    std::vector<double> ways = in_a_row(start_);
    const double length = chords_.length(line_);
    const double least_gap = 0.1 * length / static_cast<double>(ways.size());
    for (std::size_t i = 0; i < ways.size(); ++i) ways[i] -= least_gap * static_cast<double>(i);
    make_monotone(ways);
    for (std::size_t i = 0; i < ways.size(); ++i) ways[i] += least_gap * static_cast<double>(i);
    double gap = ways.front() + length - ways.back();
    if (gap < least_gap) return false;
    for (std::size_t i = 1; i < ways.size(); ++i) gap = std::max(gap, ways[i] - ways[i - 1]);
    if (gap > widest * length) return false;
    for (std::size_t i = 0; i < ways.size(); ++i) put(vertices_[i], ways[i]);
    return true;
  }

  /// Evenly, in the order in which the vertices are, all of them turned to where they were before,
  /// as far as there is such a turn.
  void put_evenly() {
    const double around = 2 * std::numbers::pi, length = chords_.length(line_);
    const double step = around / static_cast<double>(vertices_.size());
    std::complex<double> turn = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      turn += std::polar(1.0, around * start_[i] / length - step * static_cast<double>(i));
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const double angle = std::arg(turn) + step * static_cast<double>(i);
      put(vertices_[i], length * angle / around);
    }
  }

  /// How far the faces along the line look where the surface does: positive if they do.
  double uprightness(const VertexFaces& around, const std::function<Vec3(Index)>& upward) const {
    double sum = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const Index a = vertices_[i], b = vertices_[(i + 1) % vertices_.size()];
      for (const Index f : around[a]) {
        const auto face = std::as_const(mesh_.faces)[f];
        const auto n = face.size();
        const auto k = static_cast<std::size_t>(std::ranges::find(face, a) - face.begin());
        const bool ahead = face[(k + 1) % n] == b, back = face[(k + n - 1) % n] == b;
        if (!ahead && !back) continue;
        const Vec3 along = mesh_.positions[b] - mesh_.positions[a];
        for (const Index w : face) {
          const float side = along.cross(mesh_.positions[w] - mesh_.positions[a]).dot(upward(w));
          sum += ahead ? side : -side;
        }
      }
    }
    return sum;
  }

 private:
  void put(Index v, double way) {
    const Chords::Stop stop = chords_.stop_at(line_, way);
    mesh_.positions[v] = stop.position;
    rails_.set_place(v, stop.segment);
  }

  /// The way from one place to another, of both ways around the shorter one.
  double step(double from, double to) const {
    return std::remainder(to - from, chords_.length(line_));
  }

  double rounds_of(const std::vector<double>& ways) const {
    double sum = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) sum += step(ways[i], ways[(i + 1) % ways.size()]);
    return sum / chords_.length(line_);
  }

  /// The same places, each near the one before it.
  std::vector<double> in_a_row(std::vector<double> ways) const {
    for (std::size_t i = 1; i < ways.size(); ++i)
      ways[i] = ways[i - 1] + step(ways[i - 1], ways[i]);
    return ways;
  }

  /// The first vertex becomes one that is farthest from both of its neighbours, in order.
  void begin_at_best() {
    const std::size_t count = start_.size();
    std::size_t best = 0;
    double farthest = -chords_.length(line_);
    for (std::size_t i = 0; i < count; ++i) {
      const double least = std::min(step(start_[(i + count - 1) % count], start_[i]),
                                    step(start_[i], start_[(i + 1) % count]));
      if (least <= farthest) continue;
      farthest = least;
      best = i;
    }
    const auto first = static_cast<std::ptrdiff_t>(best);
    std::rotate(vertices_.begin(), vertices_.begin() + first, vertices_.end());
    std::rotate(start_.begin(), start_.begin() + first, start_.end());
  }

  /// The nearest numbers (least squares) that do not decrease: means of what is out of order.
  static void make_monotone(std::vector<double>& numbers) {
    struct Block {
      double sum;
      std::size_t count;
      double mean() const { return sum / static_cast<double>(count); }
    };
    std::vector<Block> blocks;
    for (const double number : numbers) {
      Block block{number, 1};
      while (!blocks.empty() && blocks.back().mean() > block.mean()) {
        block = {block.sum + blocks.back().sum, block.count + blocks.back().count};
        blocks.pop_back();
      }
      blocks.push_back(block);
    }
    auto next = numbers.begin();
    for (const Block& block : blocks) next = std::fill_n(next, block.count, block.mean());
  }

  Mesh& mesh_;
  const Chords& chords_;
  Rails& rails_;
  Index line_;
  std::vector<Index> vertices_;
  std::vector<double> start_;  // their ways
};

}  // namespace

void go_around(Mesh& mesh, const VertexFaces& around, const std::function<Vec3(Index)>& upward,
               Chords& chords, Rails& rails) {
  for (Chain& chain : find_chains(chords)) {
    if (!chain.is_closed() || !rails.slides(chain.vertices.front())) continue;
    const bool good = find_stops(chain, chords) && goes_around(chain, chords.length(chain.line));
    Spread spread(mesh, chords, rails, chain);
    if (!good && !spread.put_in_order()) {
      spread.put_evenly();
      const double one_way = spread.uprightness(around, upward);
      spread.reverse();
      spread.put_evenly();
      if (spread.uprightness(around, upward) < one_way) {
        spread.reverse();
        spread.put_evenly();
      }
    }
    chords.set_order(spread.vertices());
  }
}

}  // namespace meshgrain
