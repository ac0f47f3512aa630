#include "sharpen/noisy_part.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "features/mechanical_creases.h"
#include "mesh/pieces.h"
#include "meshgrain/surface.h"
#include "sharpen/crease_net.h"
#include "sharpen/normal_filter.h"

namespace meshgrain {
namespace {

/// How many times longer the creases of a part must be than all that is less sharp, once the noise
/// is out: the filter makes edges of some of what is smooth, too.
constexpr double clearly = 2;

/// Whether so many edges are not flat that it may be noise.
bool may_be_noisy(const Mesh& triangles, const Context& context) {
  constexpr double least_share = 0.15;  // of the length of all edges
  double length = 0;
  for (const auto& [ends, cosine] : sharp_edges(triangles, flat_degrees, context)) {
    length += (triangles.positions[ends[0]] - triangles.positions[ends[1]]).norm();
  }
  const auto sides = static_cast<double>(triangles.faces.corners().size());
  return length > least_share * edge_lengths(triangles, context).mean * sides / 2;
}

/// Whether each vertex is as far above its neighbours as these are above theirs, as on a surface
/// that bends evenly and is only coarse; with noise it is so by chance.
bool bends_evenly(const Mesh& triangles) {
  const std::size_t count = triangles.positions.size();
  std::vector<Vec3> normals(count, Vec3::Zero()), sums(count, Vec3::Zero());
  std::vector<float> weights(count, 0), heights(count), sums_of_heights(count, 0);
  for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
    const auto face = triangles.faces[f];
    const Vec3 &a = triangles.positions[face[0]], &b = triangles.positions[face[1]],
               &c = triangles.positions[face[2]];
    const Vec3 normal = (b - a).cross(c - a), sum = a + b + c;
    for (const Index v : face) {
      normals[v] += normal;
      sums[v] += (sum - triangles.positions[v]) / 2;
      weights[v] += 1;
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3 above = triangles.positions[v] - sums[v] / std::max(weights[v], 1.0f);
    heights[v] = above.dot(normals[v].normalized());
  }
  for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
    const auto face = triangles.faces[f];
    const float sum = heights[face[0]] + heights[face[1]] + heights[face[2]];
    for (const Index v : face) sums_of_heights[v] += (sum - heights[v]) / 2;
  }
  double height = 0, deviation = 0;
  for (std::size_t v = 0; v < count; ++v) {
    height += std::abs(heights[v]);
    deviation += std::abs(heights[v] - sums_of_heights[v] / std::max(weights[v], 1.0f));
  }
  // Noisy parts have 0.7 to 1.2, sculptures that are finely meshed 0.05 to 0.9.
  constexpr double most = 0.4;
  return deviation < most * height;
}

/// Whether more than a little of it is in pieces of so few vertices that noise and shape cannot be
/// told apart: low-poly stones are as rough as scans.
bool is_of_small_pieces(const Mesh& triangles) {
  constexpr std::size_t small = 1000;
  constexpr double most = 0.1;
  UnionFind pieces = pieces_of(triangles);
  std::vector<std::size_t> sizes(triangles.positions.size(), 0);
  for (Index v = 0; v < sizes.size(); ++v) ++sizes[pieces.find(v)];
  std::size_t in_small = 0;
  for (const std::size_t size : sizes) in_small += size < small ? size : 0;
  return static_cast<double>(in_small) > most * static_cast<double>(sizes.size());
}

/// Of a sample. The creases of a part are there long before all of the noise is out:
/// where there are hardly any then, they need not be exact.
CreaseLengths lengths_without_noise(Mesh sample, const Context& context) {
  constexpr int first_look = 3;       // after so many rounds, where parts have more than twice as
  constexpr double hopeless = 0.125;  // much of clear creases as of doubtful ones
  NormalFilter filter(sample, NormalFilter::Border::moves, context);
  CreaseLengths lengths{};
  for (const int rounds : {first_look, NormalFilter::rounds}) {
    filter.run(rounds);
    lengths = crease_lengths(sample, sharp_edges(sample, flat_degrees, context), context);
    if (lengths.clear <= hopeless * lengths.doubtful) break;
  }
  return lengths;
}

}  // namespace

bool is_noisy_part(const Mesh& triangles, std::span<const Mesh, 2> samples,
                   const Context& context) {
  const Mesh& less = samples[0];
  const Mesh& more = samples[1];
  if (bends_evenly(more) || !may_be_noisy(more, context)) return false;
  constexpr double margin = 0.75;
  const CreaseLengths hint = lengths_without_noise(less, context);
  if (hint.clear < margin * hint.doubtful) return false;
  const bool is_all = less.faces.size() == more.faces.size();
  const CreaseLengths found = is_all ? hint : lengths_without_noise(more, context);
  if (found.clear <= margin * clearly * found.doubtful) return false;
  // Noise leaves few edges as sharp as creases: else these are there without it, or it is a
  // sculpture with few large faces.
  const RimAndSharpEdges edges = rim_and_sharp_edges(triangles, flat_degrees, context);
  const CreaseLengths as_it_is = crease_lengths(triangles, edges.sharp, context);
  return as_it_is.clear <= as_it_is.doubtful && !is_of_small_pieces(triangles) &&
         kind_of_surface(triangles, edges, context) != SurfaceKind::mechanical_part;
}

std::vector<std::array<Index, 2>> take_out_noise(Mesh& triangles, double shortest,
                                                 const Context& context) {
  NormalFilter(triangles, NormalFilter::Border::stays, context).run();
  const auto sharp = sharp_edges(triangles, flat_degrees, context);
  const auto found = clear_creases(triangles, sharp, clearly, context);
  if (found.empty()) return {};
  return connect_creases(triangles, found, shortest, context);
}

}  // namespace meshgrain
