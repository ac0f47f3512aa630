#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "finish/rails.h"
#include "meshgrain/context.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// The edges of a mesh that follow feature lines, and how much of these they cut off.
class Chords {
 public:
  /// A point of a line. Its way is from the line's beginning; along closed lines ways go on over
  /// the end, so that they grow along a chain of edges.
  struct Stop {
    double way;
    Index segment;  // by the place in FeatureLines::vertices where that begins
    Vec3 position;
  };

  /// Mesh and rails must outlive this; where vertices are may change.
  Chords(const Mesh& mesh, std::span<const LineEdge> edges, const Rails& rails);

  const FeatureLines& lines() const { return rails_.lines(); }

  std::size_t vertices() const { return line_.size(); }
  /// Of a vertex that slid along a line at first, and no_index of all others.
  Index line(Index v) const { return line_[v]; }
  /// The vertices before and after a sliding one, in no order if none was set; no_index where there
  /// is none.
  const std::array<Index, 2>& beside(Index v) const { return beside_[v]; }

  /// Never 0, also if all of the line is one place.
  double length(Index line) const { return std::max(ways_[lines().end(line) - 1], 1e-30); }

  /// Where on a line a vertex is, by the way that is nearest to `near`. Nothing if it does not
  /// slide, and stays elsewhere than at an end of the line.
  std::optional<double> way(Index v, Index line, double near) const {
    return way(v, mesh_.positions[v], line, near);
  }
  Stop stop_at(Index line, double way) const;

  /// From now on the first two of these vertices follow each other along a closed line, and so on,
  /// the last one and the first as well.
  void set_order(std::span<const Index> around);

  /// Notes where all that slide are.
  void note_ways(const Context& context);
  /// Where a vertex that wants to slide to p goes: no farther than half of the way from where it
  /// was noted to its neighbours, so that none passes another even if all slide at once. Where its
  /// edges lie far from a crease that turns, it goes to where both are as far. Around
  /// closed lines the order is that of set_order(), and there, the more of the line is between
  /// them, the more evenly: edges over half of it are not long. Nothing if the neighbours were not
  /// on both sides.
  std::optional<Stop> slide(Index v, const Vec3& p) const;

  /// How much of a line the chord between two of its points cuts off: the integral over the line of
  /// its squared distance from the chord beyond what is tolerated, in edge lengths.
  double cut_off(Index line, const Stop& from, const Stop& to) const;
  /// By the two edges of a vertex that slides.
  double cut_off(Index v) const;

 private:
  using Ways = std::array<std::optional<double>, 2>;

  /// Whether an edge of v along a crease may lie far from it. Quick, as most creases are straight.
  bool may_lie_far(Index v, const Ways& beside) const;
  /// The way between two others where the chords to these lie as far from the line, the more so the
  /// farther they lie from it at `here`; else `to`.
  double balance(Index line, double before, double here, double after, double to) const;
  /// How far the line between two ways bends away from the chord between them, in edge lengths;
  /// what goes to and fro is not far.
  double depth(Index line, double from, double to) const;
  /// Where the vertices beside one were noted.
  Ways ways_beside(Index v) const;
  std::optional<double> way(Index v, const Vec3& p, Index line, double near) const;

  const Mesh& mesh_;
  const Rails& rails_;
  std::vector<double> ways_;  // of the lines' vertices
  std::vector<std::array<Index, 2>> beside_;
  std::vector<Index> line_;
  std::vector<std::uint8_t> noted_slides_;  // of each vertex, see note_ways()
  std::vector<double> noted_;               // ways of vertices
  std::vector<std::uint8_t> goes_around_;   // in order: `beside_` has the one behind first
  // How many faces lead from a vertex on along its line: two beside creases, one beside borders.
  std::vector<std::uint8_t> faces_beside_;
  double edge_ = 0;  // the mean length
};

}  // namespace meshgrain
