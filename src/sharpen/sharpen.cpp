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

/// Some of the surface tells at once that most scans are no part, and less of it that most
/// sculptures are none. Among few vertices shape and blur cannot be told apart.
Blur blur_of(const Mesh& triangles, const Context& context) {
  constexpr std::size_t few = 2000;
  if (triangles.positions.size() < few) return Blur::none;
  Mesh more = sample_patches(triangles, 32, 500, context);
  Mesh less = sample_patches(more, 16, 250, context);
  const std::array samples{std::move(less), std::move(more)};
  if (is_chamfered_part(triangles, samples, context)) return Blur::chamfers;
  if (is_noisy_part(triangles, samples, context)) return Blur::noise;
  return Blur::none;
}

}  // namespace

Blur sharpen(Mesh& triangles, double edge_length, const Context& context) {
  const Blur blur = blur_of(triangles, context);
  if (blur == Blur::none) return blur;
  Mesh sharp = triangles;
  const std::vector<std::array<Index, 2>> creases =
      blur == Blur::chamfers ? sharpen_chamfers(sharp, edge_length, context)
                             : take_out_noise(sharp, edge_length, context);
  if (creases.empty()) return Blur::none;
  sharp.marked_edges.insert(sharp.marked_edges.end(), creases.begin(), creases.end());
  join_near_corners(sharp, 0.6 * edge_length, context);
  const Corners corners = blur == Blur::chamfers ? Corners::stay : Corners::move;
  straighten_lines(sharp, noisy_lines(sharp, edge_length), corners, context);
  triangles = std::move(sharp);
  return blur;
}

}  // namespace meshgrain
