#include "remesh/check_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "meshgrain/error.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

/// Beyond them corners and neighbours, which are several for each, cannot be told apart by an
/// Index.
void check_size(std::size_t count, std::string_view what) {
  constexpr std::size_t most = std::size_t{1} << 31;
  if (count < most) return;
  throw Error(
      fmt::format("too large: the input has {} {}, and may have {}", count, what, most - 1));
}

/// One for each vertex, or none at all.
void check_count(std::size_t count, std::size_t vertices, std::string_view what) {
  if (count == 0 || count == vertices) return;
  throw Error(fmt::format("the input has {} {} for {} vertices", count, what, vertices));
}

}  // namespace

void check_input(const Mesh& input, const Context& context) {
  const std::size_t vertices = input.positions.size();
  check_size(vertices, "vertices");
  check_size(input.faces.size(), "faces");
  check_count(input.normals.size(), vertices, "normals");
  check_count(input.values.size(), vertices, "values");
  const auto is_out_of_range = [&](Index v) { return v >= vertices; };
  const auto wrong_faces = indices_where(
      input.faces.size(),
      [&](Index f) { return std::ranges::any_of(input.faces[f], is_out_of_range); }, context);
  if (!wrong_faces.empty()) {
    const auto face = input.faces[wrong_faces.front()];
    throw Error(fmt::format("face {} of the input has the vertex {}, but there are {} vertices",
                            wrong_faces.front(), *std::ranges::find_if(face, is_out_of_range),
                            vertices));
  }
  for (const auto& [a, b] : input.marked_edges) {
    if (!is_out_of_range(std::max(a, b))) continue;
    throw Error(
        fmt::format("a marked edge of the input has the vertex {}, but there are {} vertices",
                    std::max(a, b), vertices));
  }
  const auto not_finite = indices_where(
      vertices,
      [&](Index v) {
        return !input.positions[v].allFinite() ||
               (!input.normals.empty() && !input.normals[v].allFinite()) ||
               (!input.values.empty() && !std::isfinite(input.values[v]));
      },
      context);
  if (!not_finite.empty() || !input.origin.allFinite()) {
    throw Error(not_finite.empty()
                    ? std::string("the origin of the input is not finite")
                    : fmt::format("vertex {} of the input is not finite", not_finite.front()));
  }
}

}  // namespace meshgrain
