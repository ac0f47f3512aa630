#include "features/mechanical_creases.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "features/clean_lines.h"
#include "features/fading_creases.h"

namespace meshgrain {
namespace {

constexpr double sharp = 40;  // degrees
// Of sculptures and scans it is hardly ever more than a half.
constexpr double clean_enough = 0.8;

double cosine_of(double degrees) {
  return std::cos(degrees * std::numbers::pi / 180);
}

double length_above(const Mesh& mesh, std::span<const SharpEdge> edges, double degrees) {
  const double cosine = cosine_of(degrees);
  double sum = 0;
  for (const SharpEdge& edge : edges) {
    const auto [a, b] = edge.ends;
    if (edge.cosine < cosine) sum += (mesh.positions[a] - mesh.positions[b]).norm();
  }
  return sum;
}

/// Flags of those sharper than an angle at which it matters least.
std::vector<std::uint8_t> above_best_threshold(const Mesh& mesh, std::span<const SharpEdge> edges) {
  double threshold = sharp, least = std::numeric_limits<double>::infinity();
  constexpr double lowest = 20, window = 1.25, step = 2;
  for (double degrees = sharp; degrees >= lowest; degrees -= step) {
    const double doubtful =
        length_above(mesh, edges, degrees / window) - length_above(mesh, edges, degrees * window);
    if (doubtful >= least) continue;
    least = doubtful;
    threshold = degrees;
  }
  std::vector<std::uint8_t> result;
  const double cosine = cosine_of(threshold);
  for (const SharpEdge& edge : edges) result.push_back(edge.cosine < cosine);
  return result;
}

std::vector<std::array<Index, 2>> flagged(std::span<const SharpEdge> edges,
                                          const std::vector<std::uint8_t>& flags) {
  std::vector<std::array<Index, 2>> result;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (flags[e]) result.push_back(edges[e].ends);
  }
  return result;
}

}  // namespace

CreaseLengths crease_lengths(const Mesh& mesh, std::span<const SharpEdge> edges) {
  const double clear = length_above(mesh, edges, sharp);
  return {clear, length_above(mesh, edges, flat_degrees) - clear};
}

std::vector<std::array<Index, 2>> clear_creases(const Mesh& mesh, std::span<const SharpEdge> edges,
                                                double clearly) {
  const CreaseLengths lengths = crease_lengths(mesh, edges);
  if (lengths.clear <= clearly * lengths.doubtful) return {};
  return flagged(edges, above_best_threshold(mesh, edges));
}

std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& mesh,
                                                     const RimAndSharpEdges& edges) {
  const CreaseLengths lengths = crease_lengths(mesh, edges.sharp);
  const bool is_mechanical =
      lengths.clear > lengths.doubtful || share_of_clean_lines(mesh, edges, sharp) > clean_enough;
  if (!is_mechanical) return {};
  std::vector<std::uint8_t> is_crease = above_best_threshold(mesh, edges.sharp);
  follow_fading_creases(mesh, edges.sharp, is_crease);
  return flagged(edges.sharp, is_crease);
}

}  // namespace meshgrain
