#include "sharpen/sharpen.h"

#include <array>
#include <utility>
#include <vector>

#include "sharpen/chamfered_part.h"
#include "sharpen/join_corners.h"
#include "sharpen/noisy_lines.h"
#include "sharpen/noisy_part.h"
#include "sharpen/sample_patches.h"
#include "sharpen/sharpen_chamfers.h"
#include "sharpen/straighten.h"

namespace meshgrain {
namespace {

/// With its creases sharp and marked, for what they were hidden by.
Mesh with_creases(Mesh sharp, const std::vector<std::array<Index, 2>>& creases, Corners corners,
                  double edge_length, const Context& context) {
  sharp.marked_edges.insert(sharp.marked_edges.end(), creases.begin(), creases.end());
  join_near_corners(sharp, 0.6 * edge_length, context);
  straighten_lines(sharp, noisy_lines(sharp, edge_length), corners, context);
  return sharp;
}

}  // namespace

Blur sharpen(Mesh& triangles, double edge_length, const Context& context) {
  // Among few vertices shape and blur cannot be told apart.
  constexpr std::size_t few = 2000;
  if (triangles.positions.size() < few) return Blur::none;
  // Some of the surface tells at once that most scans are no part, and less of it that most
  // sculptures are none.
  Mesh more = sample_patches(triangles, 32, 500, context);
  Mesh less = sample_patches(more, 16, 250, context);
  const std::array samples{std::move(less), std::move(more)};
  const Chamfered chamfered = chamfered_part(triangles, samples, context);
  if (chamfered != Chamfered::no) {
    Mesh sharp = triangles;
    const auto creases = sharpen_chamfers(sharp, edge_length, chamfered, context);
    if (!creases.empty()) {
      triangles = with_creases(std::move(sharp), creases, Corners::stay, edge_length, context);
      return Blur::chamfers;
    }
    if (chamfered == Chamfered::yes) return Blur::none;
  }
  if (!is_noisy_part(triangles, samples, context)) return Blur::none;
  Mesh sharp = triangles;
  const auto creases = take_out_noise(sharp, edge_length, context);
  if (creases.empty()) return Blur::none;
  triangles = with_creases(std::move(sharp), creases, Corners::move, edge_length, context);
  return Blur::noise;
}

}  // namespace meshgrain
