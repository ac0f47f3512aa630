#pragma once

#include <Eigen/Core>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// Curves in space, such as the lines of an OBJ file.
struct Polylines {
  std::vector<Eigen::Vector3d> points;  ///< In units of the input, from zero: no origin is added.
  /// Indices of points, line after line, in the order in which a line runs: at least two a line,
  /// each other than the one before. A closed line ends with the point that it began with.
  std::vector<Index> vertices;
  std::vector<Index> starts{0};  ///< Lines + 1: where each begins in `vertices`.

  std::size_t size() const { return starts.size() - 1; }
  bool empty() const { return vertices.empty(); }
  Index begin(std::size_t line) const { return starts[line]; }
  Index end(std::size_t line) const { return starts[line + 1]; }
};

}  // namespace meshgrain
