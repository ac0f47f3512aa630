#include "features/mechanical_creases.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

#include "features/clean_lines.h"
#include "features/fading_creases.h"
#include "measure/face_shape.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

constexpr double less_sharp_degrees = 30;

double length_above(const Mesh& mesh, std::span<const SharpEdge> edges, double degrees,
                    const Context& context) {
  const double cosine = sharp_cosine(degrees);
  const auto length = [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (const auto& [ends, cosine_here] : edges.subspan(begin, end - begin)) {
      if (!(cosine_here < cosine)) continue;
      sum += (mesh.positions[ends[0]] - mesh.positions[ends[1]]).norm();
    }
    return sum;
  };
  return sum_over_ranges(edges.size(), length, context);
}

/// Flags of those sharper than an angle at which it matters least.
std::vector<std::uint8_t> above_best_threshold(const Mesh& mesh, std::span<const SharpEdge> edges,
                                               const Context& context) {
  double threshold = sharp_degrees, least = std::numeric_limits<double>::infinity();
  constexpr double lowest = 20, window = 1.25, step = 2;
  for (double degrees = sharp_degrees; degrees >= lowest; degrees -= step) {
    const double doubtful = length_above(mesh, edges, degrees / window, context) -
                            length_above(mesh, edges, degrees * window, context);
    if (doubtful >= least) continue;
    least = doubtful;
    threshold = degrees;
  }
  std::vector<std::uint8_t> result;
  const double cosine = sharp_cosine(threshold);
  for (const SharpEdge& edge : edges) result.push_back(edge.cosine < cosine);
  return result;
}

/// Of all sharp edges, by their length.
double share_that_sticks_out(const Mesh& mesh, const Context& context) {
  const double cosine = sharp_cosine(sharp_degrees);
  const auto normal = [&](Index f) -> Vec3 {
    return area_vector(mesh.faces[f], mesh.positions).stableNormalized();
  };
  const auto is_sharp = [&](const InnerEdge& edge) {
    return normal(edge.left).dot(normal(edge.right)) < cosine;
  };
  double out = 0, all = 0;
  for (const auto& [ends, left, right] : inner_edges(mesh, is_sharp, context)) {
    const Vec3 &a = mesh.positions[ends[0]], &b = mesh.positions[ends[1]];
    Vec3 middle = Vec3::Zero();  // of the other face
    for (const Index v : mesh.faces[right]) middle += mesh.positions[v] / 3;
    const double length = (b - a).norm();
    all += length;
    if (normal(left).dot(middle - a) < 0) out += length;
  }
  return all > 0 ? out / all : 0;
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

CreaseLengths crease_lengths(const Mesh& mesh, std::span<const SharpEdge> edges,
                             const Context& context) {
  const double clear = length_above(mesh, edges, sharp_degrees, context);
  return {clear, length_above(mesh, edges, flat_degrees, context) - clear};
}

std::vector<std::array<Index, 2>> clear_creases(const Mesh& mesh, std::span<const SharpEdge> edges,
                                                double clearly, const Context& context) {
  const CreaseLengths lengths = crease_lengths(mesh, edges, context);
  if (lengths.clear <= clearly * lengths.doubtful) return {};
  return flagged(edges, above_best_threshold(mesh, edges, context));
}

SurfaceKind kind_of_surface(const Mesh& mesh, const RimAndSharpEdges& edges,
                            const Context& context) {
  constexpr double clearly = 4;
  const auto [clear, doubtful] = crease_lengths(mesh, edges.sharp, context);
  // Even where noise has made the lines ragged.
  if (clear > clearly * doubtful) return SurfaceKind::mechanical_part;
  // Of sculptures and scans the clean share is hardly ever more than a half.
  constexpr double clean = 0.8, clean_enough = 0.6, partly_clean = 0.45;
  const double share = share_of_clean_lines(mesh, edges, sharp_degrees);
  if (share > clean) return SurfaceKind::mechanical_part;
  // Of a sculpture with few large faces most edges may be sharp, but then they are no clean lines.
  // On a surface around voxels hardly any are, but for all of its small steps together.
  constexpr double too_ragged = 0.05;
  const auto share_of_less_sharp = [&] {
    return share_of_clean_lines(mesh, edges, less_sharp_degrees);
  };
  if (clear > doubtful && share > too_ragged &&
      (share > clean_enough || share_of_less_sharp() > clean_enough)) {
    return SurfaceKind::mechanical_part;
  }
  // Measured on 670 parts, and on 220 sculptures, scans, bones and a car's body.
  constexpr double outer = 0.35;
  const auto is_clean_beside_facets = [&] {
    const double about_right = length_above(mesh, edges.sharp, about_right_degrees, context);
    return share + about_right / clear > clean &&  // no others become clean
           share_of_clean_lines(mesh, edges, sharp_degrees, Beside::facets) > clean;
  };
  const bool is_part = (share > partly_clean || is_clean_beside_facets()) &&
                       share_that_sticks_out(mesh, context) > outer;
  return is_part ? SurfaceKind::rounded_part : SurfaceKind::sculpture;
}

std::vector<std::array<Index, 2>> mechanical_creases(const Mesh& mesh,
                                                     std::span<const SharpEdge> edges,
                                                     const Context& context) {
  std::vector<std::uint8_t> is_crease = above_best_threshold(mesh, edges, context);
  follow_fading_creases(mesh, edges, is_crease);
  return flagged(edges, is_crease);
}

}  // namespace meshgrain
