#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "finish/rails.h"
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

  /// Of a vertex that slid along a line at first, and no_index of all others.
  Index line(Index v) const { return line_[v]; }
  /// The vertices before and after a sliding one, in no order; no_index where there is none.
  const std::array<Index, 2>& beside(Index v) const { return beside_[v]; }

  double length(Index line) const { return ways_[lines().end(line) - 1]; }

  /// Where on a line a vertex is, by the way that is nearest to `near`. Nothing if it does not
  /// slide, and stays elsewhere than at an end of the line.
  std::optional<double> way(Index v, Index line, double near) const;
  Stop stop_at(Index line, double way) const;

  /// How much of a line the chord between two of its points cuts off: the integral over the line of
  /// its squared distance from the chord beyond what is tolerated, in edge lengths.
  double cut_off(Index line, const Stop& from, const Stop& to) const;
  /// By the two edges of a vertex that slides.
  double cut_off(Index v) const;

 private:
  const Mesh& mesh_;
  const Rails& rails_;
  std::vector<double> ways_;  // of the lines' vertices
  std::vector<std::array<Index, 2>> beside_;
  std::vector<Index> line_;
  double edge_ = 0;  // the mean length
};

}  // namespace meshgrain
