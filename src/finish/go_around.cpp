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

/// Whether the vertices of a closed chain follow each other once around, none from far behind.
bool goes_around(const Chain& chain, double length) {
  constexpr double widest = 0.4;  // of the line: the straight way must not be on the other side
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

  /// In the order in which the vertices are, all of them turned to where they were before, as far
  /// as there is such a turn.
  void put() {
    const double around = 2 * std::numbers::pi, length = chords_.length(line_);
    const double step = around / static_cast<double>(vertices_.size());
    std::complex<double> turn = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      turn += std::polar(1.0, around * start_[i] / length - step * static_cast<double>(i));
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const double angle = std::arg(turn) + step * static_cast<double>(i);
      const Chords::Stop stop = chords_.stop_at(line_, length * angle / around);
      mesh_.positions[vertices_[i]] = stop.position;
      rails_.set_place(vertices_[i], stop.segment);
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
    if (!good) {
      spread.put();
      const double one_way = spread.uprightness(around, upward);
      spread.reverse();
      spread.put();
      if (spread.uprightness(around, upward) < one_way) {
        spread.reverse();
        spread.put();
      }
    }
    chords.set_order(spread.vertices());
  }
}

}  // namespace meshgrain
