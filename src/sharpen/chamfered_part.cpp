#include "sharpen/chamfered_part.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "features/mechanical_creases.h"
#include "mesh/border.h"
#include "meshgrain/surface.h"
#include "sharpen/chamfers.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 512;

/// Whether hardly any of the area has far longer edges than usual: a grid samples flat sides as
/// finely as all else, for which CAD models have a few large triangles.
bool is_evenly_sampled(const Mesh& triangles, const Context& context) {
  constexpr double far_longer = 3, hardly_any = 0.1;
  const double longest = far_longer * edge_lengths(triangles, context).mean;
  double large = 0, whole = 0;
  for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
    const auto face = triangles.faces[f];
    const Vec3 &a = triangles.positions[face[0]], &b = triangles.positions[face[1]],
               &c = triangles.positions[face[2]];
    const double area = (b - a).cross(c - a).norm();
    whole += area;
    if (std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()}) > longest) large += area;
  }
  return large <= hardly_any * whole;
}

/// Whether edges are of a few lengths only, as where cells of a grid are full or empty: chamfers of
/// such have sharp edges themselves, but stand for creases.
bool has_few_lengths(const Mesh& triangles) {
  constexpr std::size_t few = 24;
  constexpr float rounding = 1e-3f;
  std::vector<float> known;
  for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
    const auto face = triangles.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const float length =
          (triangles.positions[face[(k + 1) % 3]] - triangles.positions[face[k]]).norm();
      const auto is_it = [&](float other) { return std::abs(length - other) <= rounding * other; };
      if (std::ranges::any_of(known, is_it)) continue;
      if (known.size() == few) return false;
      known.push_back(length);
    }
  }
  return true;
}

/// How many vertices are not smooth, and how many of these lie at a crease between two smooth
/// parts, or beside one that does.
struct RoughVertices {
  std::size_t all = 0, at_creases = 0;
  std::size_t faces = 0;  // with such corners alone: chamfers have them, creases hardly any
};

RoughVertices rough_vertices(const Mesh& triangles, const Context& context) {
  constexpr int edges = 2;  // roundings are wider
  const Chamfers chamfers(triangles, edges, context);
  const std::size_t count = triangles.positions.size();
  using Flags = std::vector<std::uint8_t>;
  const auto flag = [&](const auto& test) {
    Flags flags(count, 0);
    context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
      for (auto v = static_cast<Index>(begin); v < end; ++v) {
        if (!chamfers.is_smooth(v)) flags[v] = test(v);
      }
    });
    return flags;
  };
  const auto grown = [&](const Flags& flags) {
    const auto is_flagged = [&](Index v) { return flags[v] != 0; };
    return flag([&](Index v) { return is_flagged(v) || chamfers.any_beside(v, is_flagged); });
  };
  const auto at_crease = flag([&](Index v) {
    return chamfers.any_beside(v, [&](Index w) { return chamfers.meet_in_crease(v, w); });
  });
  const Flags beside_crease = grown(at_crease);
  // At a rim, such as a sample has, too little is around.
  const Flags near_rim = grown(grown(mark_ends(rim_edges(triangles, context), count)));
  RoughVertices rough;
  for (Index v = 0; v < count; ++v) {
    if (chamfers.is_smooth(v) || near_rim[v]) continue;
    ++rough.all;
    rough.at_creases += beside_crease[v];
  }
  const auto is_rough = [&](Index v) { return !chamfers.is_smooth(v) && !near_rim[v]; };
  for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
    rough.faces += std::ranges::all_of(triangles.faces[f], is_rough);
  }
  return rough;
}

}  // namespace

Chamfered chamfered_part(const Mesh& triangles, std::span<const Mesh> samples,
                         const Context& context) {
  // Parts have .95 to 1. In between are parts with rods, handles and bores of a few cells, which
  // are not smooth either; but so are shapes with roundings of two cells, and some sculptures.
  constexpr double least = 0.95, least_of_some = 0.6, least_of_sample = 0.5;
  constexpr std::size_t telling = 100;  // vertices
  const auto share = [](const RoughVertices& rough) {
    return static_cast<double>(rough.at_creases) /
           static_cast<double>(std::max<std::size_t>(rough.all, 1));
  };
  for (const Mesh& sample : samples) {
    if (sample.faces.size() == triangles.faces.size()) break;  // what is all of it comes next
    const RoughVertices rough = rough_vertices(sample, context);
    if (rough.all >= telling && share(rough) < least_of_sample) return Chamfered::no;
  }
  if (!is_evenly_sampled(triangles, context)) return Chamfered::no;
  const RoughVertices rough = rough_vertices(triangles, context);
  if (share(rough) < least_of_some) return Chamfered::no;
  // Bevels that most of the vertices lie on are what the part is, whatever it was sampled on.
  const bool is_of_cells = 2 * rough.faces > rough.all && has_few_lengths(triangles);
  const double most_rough = is_of_cells ? 0.6 : 0.25;
  const auto vertices = static_cast<double>(triangles.positions.size());
  if (static_cast<double>(rough.all) > most_rough * vertices) return Chamfered::no;
  const RimAndSharpEdges edges = rim_and_sharp_edges(triangles, flat_degrees, context);
  const bool has_creases =
      kind_of_surface(triangles, edges, context) == SurfaceKind::mechanical_part;
  if (has_creases && !is_of_cells) return Chamfered::no;
  return share(rough) < least ? Chamfered::perhaps : Chamfered::yes;
}

}  // namespace meshgrain
