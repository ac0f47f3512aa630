#include "features/leave_out_fragments.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "features/chain_edges.h"
#include "features/line_samples.h"
#include "util/edge_of.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;
using Edge = std::array<Index, 2>;

// In sides of faces.
constexpr double twig = 2;       // an end that leads nowhere is longer
constexpr double whole = 3;      // and so is all that hangs together
constexpr double crowded = 0.8;  // lines are farther apart, but where they meet
constexpr double step = 0.1;     // between samples of a line

class Fragments {
 public:
  Fragments(const Mesh& mesh, std::span<const Edge> rim, std::vector<Edge> creases,
            double edge_length)
      : mesh_(mesh), rim_(rim), creases_(std::move(creases)), side_(edge_length) {}

  std::vector<Edge> run() && {
    prune();
    thin_out();
    prune();
    return std::move(creases_);
  }

 private:
  struct Line {
    std::vector<Index> vertices;
    double length = 0;
  };

  Point point(Index v) const { return mesh_.positions[v].cast<double>(); }

  /// The lines of what is left, which end where they meet the rim, too.
  std::vector<Line> crease_lines() const {
    std::vector<EdgeOfLine> edges;
    for (const Edge& ends : rim_) edges.push_back({ends, LineKind::border});
    for (const Edge& ends : creases_) edges.push_back({ends, LineKind::crease});
    const FeatureLines all = chain_edges(mesh_, edges, {}, side_);
    std::vector<Line> result;
    for (std::size_t line = 0; line < all.size(); ++line) {
      Line found;
      found.vertices.assign(all.vertices.begin() + all.begin(line),
                            all.vertices.begin() + all.end(line));
      if (!is_crease(found.vertices[0], found.vertices[1])) continue;
      for (std::size_t k = 1; k < found.vertices.size(); ++k) {
        found.length += (point(found.vertices[k]) - point(found.vertices[k - 1])).norm();
      }
      result.push_back(std::move(found));
    }
    return result;
  }

  bool is_crease(Index a, Index b) const {
    return std::ranges::binary_search(creases_, edge_of(a, b));
  }

  void remove(const std::vector<Line>& lines, const std::vector<std::uint8_t>& goes) {
    std::vector<Edge> gone;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!goes[i]) continue;
      for (std::size_t k = 1; k < lines[i].vertices.size(); ++k) {
        gone.push_back(edge_of(lines[i].vertices[k - 1], lines[i].vertices[k]));
      }
    }
    std::ranges::sort(gone);
    std::erase_if(creases_,
                  [&](const Edge& edge) { return std::ranges::binary_search(gone, edge); });
  }

  /// Where an end goes, others may come to lead nowhere.
  void prune() {
    constexpr int most_rounds = 16;
    for (int round = 0; round < most_rounds; ++round) {
      const std::vector<Line> lines = crease_lines();
      std::unordered_map<Index, int> ends_at;
      for (const Line& line : lines) {
        ++ends_at[line.vertices.front()];
        ++ends_at[line.vertices.back()];
      }
      for (const Edge& ends : rim_) {
        for (const Index v : ends) ++ends_at[v];
      }
      const std::vector<double> lengths = lengths_together(lines);
      std::vector<std::uint8_t> goes(lines.size(), 0);
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool leads_nowhere =
            ends_at[lines[i].vertices.front()] == 1 || ends_at[lines[i].vertices.back()] == 1;
        goes[i] = lengths[i] < whole * side_ || (leads_nowhere && lines[i].length < twig * side_);
      }
      if (std::ranges::count(goes, 1) == 0) return;
      remove(lines, goes);
    }
  }

  /// Of each line, how long all is that hangs together with it.
  static std::vector<double> lengths_together(const std::vector<Line>& lines) {
    UnionFind together(lines.size());
    std::unordered_map<Index, Index> line_at;
    for (Index i = 0; i < lines.size(); ++i) {
      for (const Index v : {lines[i].vertices.front(), lines[i].vertices.back()}) {
        together.unite(i, line_at.try_emplace(v, i).first->second);
      }
    }
    std::vector<double> sums(lines.size(), 0), result(lines.size());
    for (Index i = 0; i < lines.size(); ++i) sums[together.find(i)] += lines[i].length;
    for (Index i = 0; i < lines.size(); ++i) result[i] = sums[together.find(i)];
    return result;
  }

  /// The longest lines stay, and others of which most is farther from these.
  void thin_out() {
    const std::vector<Line> lines = crease_lines();
    std::vector<Index> order(lines.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::stable_sort(order,
                             [&](Index a, Index b) { return lines[a].length > lines[b].length; });
    LineSamples kept(crowded * side_);
    const auto keep = [&](const Point& p) { kept.add({p, Point::Zero(), Point::Zero(), 0, 0}); };
    const auto for_each_sample = [&](Index a, Index b, const auto& visit) {
      for_samples(point(a), point(b), step * side_, visit);
    };
    for (const Edge& ends : rim_) for_each_sample(ends[0], ends[1], keep);
    std::vector<std::uint8_t> goes(lines.size(), 0);
    for (const Index i : order) {
      std::vector<Point> own;
      for (std::size_t k = 1; k < lines[i].vertices.size(); ++k) {
        for_each_sample(lines[i].vertices[k - 1], lines[i].vertices[k],
                        [&](const Point& p) { own.push_back(p); });
      }
      const auto is_near = [&](const Point& p) {
        bool any = false;
        kept.for_near(p, crowded * side_, [&](const auto&, double) { any = true; });
        return any;
      };
      goes[i] = 2 * std::ranges::count_if(own, is_near) > std::ssize(own);
      if (!goes[i]) std::ranges::for_each(own, keep);
    }
    remove(lines, goes);
  }

  const Mesh& mesh_;
  std::span<const Edge> rim_;
  std::vector<Edge> creases_;
  double side_;
};

}  // namespace

std::vector<std::array<Index, 2>> leave_out_fragments(const Mesh& mesh,
                                                      std::span<const std::array<Index, 2>> rim,
                                                      std::vector<std::array<Index, 2>> creases,
                                                      double edge_length) {
  if (creases.empty() || !(edge_length > 0)) return creases;
  return Fragments(mesh, rim, std::move(creases), edge_length).run();
}

}  // namespace meshgrain
