#include "features/mechanical_creases.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace meshgrain {

std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& mesh,
                                                     const std::vector<SharpEdge>& edges,
                                                     double clearly) {
  constexpr double sharp = 40;  // degrees
  const auto is_above = [](const SharpEdge& edge, double degrees) {
    return edge.cosine < std::cos(degrees * std::numbers::pi / 180);
  };
  const auto length_above = [&](double degrees) {
    double sum = 0;
    for (const SharpEdge& edge : edges) {
      const auto [a, b] = edge.ends;
      if (is_above(edge, degrees)) sum += (mesh.positions[a] - mesh.positions[b]).norm();
    }
    return sum;
  };
  const double creases = length_above(sharp);
  if (creases <= clearly * (length_above(flat_degrees) - creases)) return {};
  // The threshold is where it matters least.
  double threshold = sharp, least = std::numeric_limits<double>::infinity();
  constexpr double lowest = 20, window = 1.25, step = 2;
  for (double degrees = sharp; degrees >= lowest; degrees -= step) {
    const double doubtful = length_above(degrees / window) - length_above(degrees * window);
    if (doubtful >= least) continue;
    least = doubtful;
    threshold = degrees;
  }
  std::vector<std::array<Index, 2>> result;
  for (const SharpEdge& edge : edges) {
    if (is_above(edge, threshold)) result.push_back(edge.ends);
  }
  return result;
}

std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& mesh, double clearly,
                                                     const Context& context) {
  return mechanical_creases(mesh, sharp_edges(mesh, flat_degrees, context), clearly);
}

}  // namespace meshgrain
