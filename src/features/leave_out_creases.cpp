#include "features/leave_out_creases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "features/line_samples.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;

// In lengths of an edge.
constexpr double step = 0.05;  // between samples of a line
constexpr double twig = 0.3;   // is left out if it then leads nowhere

/// How near a line may be to another one for how long. Where lines meet at a small angle they are
/// near for a short way only.
struct Bound {
  double distance, length;
  bool whole_lines;  // also shorter ones, if they are as near all along
};
constexpr Bound bounds[] = {{0.1, 0.5, true}, {0.25, 5, false}};
constexpr double farthest = 0.25;
/// Where so many samples of lines are in a cube as wide as that, hardly another line has room, and
/// looking at more takes long.
constexpr std::size_t crowded = 256;

class Leaving {
 public:
  Leaving(const Mesh& mesh, const std::vector<EdgeOfLine>& edges, double edge_length)
      : mesh_(mesh), edge_length_(edge_length), others_(farthest * edge_length, crowded) {
    for (const EdgeOfLine& edge : edges) kinds_.emplace(key_of(edge), edge.kind);
    lines_ = chain_edges(mesh, edges, {}, edge_length);
  }

  void run(const Context& context) {
    for (const Index line : by_rank()) {
      context.check();
      const std::vector<std::uint8_t> out = beside_others(line);
      for (std::size_t k = 0; k < out.size(); ++k) {
        if (out[k]) {
          kinds_.erase(edge(line, k));
          any_ = true;
        } else {
          add_samples(line, k);
        }
      }
    }
    if (any_) prune();
  }

  bool stays(const EdgeOfLine& edge) const { return kinds_.contains(key_of(edge)); }

 private:
  using Edge = std::array<Index, 2>;

  static Edge key_of(const EdgeOfLine& edge) { return edge_of(edge.ends[0], edge.ends[1]); }

  std::size_t edges_of(Index line) const { return lines_.end(line) - lines_.begin(line) - 1; }
  Edge edge(Index line, std::size_t k) const {
    const Index first = lines_.begin(line) + static_cast<Index>(k);
    return edge_of(lines_.vertices[first], lines_.vertices[first + 1]);
  }
  Point point(Index v) const { return mesh_.positions[v].cast<double>(); }
  double length(const Edge& edge) const { return (point(edge[1]) - point(edge[0])).norm(); }
  double length_of(Index line) const {
    double sum = 0;
    for (std::size_t k = 0; k < edges_of(line); ++k) sum += length(edge(line, k));
    return sum;
  }

  /// The lines in the order in which they may stay: those that must first, then longer ones.
  std::vector<Index> by_rank() const {
    std::vector<double> rank(lines_.size());
    for (Index line = 0; line < lines_.size(); ++line) {
      rank[line] = may_go(line) ? length_of(line) : std::numeric_limits<double>::infinity();
    }
    std::vector<Index> order(lines_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return rank[a] > rank[b]; });
    return order;
  }
  bool may_go(Index line) const { return kinds_.at(edge(line, 0)) == LineKind::crease; }

  template <typename Visit>
  void for_samples(const Edge& edge, const Visit& visit) const {
    meshgrain::for_samples(point(edge[0]), point(edge[1]), step * edge_length_, visit);
  }

  void add_samples(Index line, std::size_t k) {
    const Edge ends = edge(line, k);
    const Point along = (point(ends[1]) - point(ends[0])).normalized();
    for_samples(ends, [&](const Point& p) { others_.add({p, along, Point::Zero(), line, 0}); });
  }

  /// How far all of an edge is from other lines that run alike, at most; what is nearer than all of
  /// the bounds need not be exact.
  double distance_from_others(const Edge& ends) const {
    const Point along = (point(ends[1]) - point(ends[0])).normalized();
    constexpr double alike = 0.9;
    double most = 0;
    for_samples(ends, [&](const Point& p) {
      double least = std::numeric_limits<double>::infinity();
      others_.any_near(p, farthest * edge_length_,
                       [&](const LineSamples::Sample& other, double distance) {
                         const bool runs_alike = std::abs(along.dot(other.direction)) > alike;
                         if (runs_alike) least = std::min(least, distance);
                         return least < bounds[0].distance * edge_length_;
                       });
      most = std::max(most, least);
    });
    return most / edge_length_;
  }

  /// Which edges of a line are to be left out.
  std::vector<std::uint8_t> beside_others(Index line) const {
    const std::size_t count = edges_of(line);
    std::vector<std::uint8_t> out(count, 0);
    if (!may_go(line)) return out;
    std::vector<double> distance(count);
    for (std::size_t k = 0; k < count; ++k) distance[k] = distance_from_others(edge(line, k));
    for (const Bound& bound : bounds) {
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t first = k;
        double run = 0;
        for (; k < count && distance[k] < bound.distance; ++k) run += length(edge(line, k));
        const bool is_whole = first == 0 && k == count;
        if (run < bound.length * edge_length_ && !(is_whole && bound.whole_lines)) continue;
        std::fill(out.begin() + static_cast<std::ptrdiff_t>(first),
                  out.begin() + static_cast<std::ptrdiff_t>(k), std::uint8_t{1});
      }
    }
    return out;
  }

  /// Leaves out short ends that hang together with nothing else: those that joined two lines, of
  /// which one is gone.
  void prune() {
    std::vector<EdgeOfLine> left;
    for (const auto& [ends, kind] : kinds_) left.push_back({ends, kind});
    lines_ = chain_edges(mesh_, left, {}, edge_length_);
    std::map<Index, int> ends_at;
    for (Index line = 0; line < lines_.size(); ++line) {
      ++ends_at[lines_.vertices[lines_.begin(line)]];
      ++ends_at[lines_.vertices[lines_.end(line) - 1]];
    }
    for (Index line = 0; line < lines_.size(); ++line) {
      if (!may_go(line)) continue;
      const bool leads_nowhere = ends_at[lines_.vertices[lines_.begin(line)]] == 1 ||
                                 ends_at[lines_.vertices[lines_.end(line) - 1]] == 1;
      if (!leads_nowhere || length_of(line) >= twig * edge_length_) continue;
      for (std::size_t k = 0; k < edges_of(line); ++k) kinds_.erase(edge(line, k));
    }
  }

  const Mesh& mesh_;
  const double edge_length_;
  std::map<Edge, LineKind> kinds_;  // of the edges that are left
  FeatureLines lines_;
  LineSamples others_;
  bool any_ = false;
};

}  // namespace

std::vector<EdgeOfLine> leave_out_creases_beside_lines(const Mesh& mesh,
                                                       const std::vector<EdgeOfLine>& edges,
                                                       double edge_length, const Context& context) {
  const bool has_creases = std::ranges::any_of(
      edges, [](const EdgeOfLine& edge) { return edge.kind == LineKind::crease; });
  if (!has_creases || !(edge_length > 0)) return edges;
  Leaving leaving(mesh, edges, edge_length);
  leaving.run(context);
  std::vector<EdgeOfLine> left;
  std::ranges::copy_if(edges, std::back_inserter(left),
                       [&](const EdgeOfLine& edge) { return leaving.stays(edge); });
  return left;
}

}  // namespace meshgrain
