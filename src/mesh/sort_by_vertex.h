#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The bounds of ranges of vertices, as many as told, to which about as many faces come each, by
/// some of the faces.
template <typename VerticesOf>
std::vector<std::size_t> even_ranges(std::size_t faces, std::size_t vertices,
                                     const VerticesOf& vertices_of, std::size_t ranges) {
  constexpr std::size_t samples = 1024;
  std::vector<std::size_t> some;
  if (ranges > 1) {
    for (std::size_t f = 0; f < faces; f += faces / samples + 1) {
      for (const Index v : vertices_of(f)) some.push_back(v);
    }
    std::sort(some.begin(), some.end());
  }
  std::vector<std::size_t> bounds{0};
  for (std::size_t r = 1; r < ranges && !some.empty(); ++r) {
    bounds.push_back(some[r * some.size() / ranges]);
  }
  bounds.push_back(vertices);
  return bounds;
}

/// A counting sort of faces by vertex: each comes to those that `vertices_of(f)` lists, which
/// `put(f, place)` is told, those of a vertex in increasing order. Each range of vertices is one
/// thread's alone, which reads all faces: that is quick, as they come one after the other, and the
/// vertices that it writes do not. Returns where the places of each vertex begin, and their end.
template <typename VerticesOf, typename Put>
std::vector<Index> sort_by_vertex(std::size_t faces, std::size_t vertices,
                                  const VerticesOf& vertices_of, const Put& put,
                                  const Context& context) {
  std::vector<Index> offsets(vertices + 1, 0);
  constexpr std::size_t most_ranges = 8;
  const auto bounds = even_ranges(faces, vertices, vertices_of,
                                  std::clamp<std::size_t>(context.threads(), 1, most_ranges));
  const auto for_ranges = [&](const auto& body) {
    context.for_ranges(bounds.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r) body(bounds[r], bounds[r + 1] - bounds[r]);
    });
  };
  for_ranges([&](std::size_t begin, std::size_t count) {
    for (std::size_t f = 0; f < faces; ++f) {
      for (const Index v : vertices_of(f)) {
        if (v - begin < count) ++offsets[v];
      }
    }
  });
  // First the ends of each vertex's faces, which move down to the starts as these are filled in.
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  for_ranges([&](std::size_t begin, std::size_t count) {
    for (std::size_t f = faces; f-- > 0;) {
      for (const Index v : vertices_of(f)) {
        if (v - begin < count) put(f, --offsets[v]);
      }
    }
  });
  return offsets;
}

/// Calls `body` with what tells the corners of a face: that is quicker where all are triangles.
template <typename Body>
auto with_corners(const Faces& faces, const Body& body) {
  const Index* const corners = faces.corners().data();
  if (faces.uniform_degree() == 3) {
    return body([corners](std::size_t f) { return std::span<const Index, 3>(corners + 3 * f, 3); });
  }
  return body([&](std::size_t f) { return faces[f]; });
}

/// The same for each face at the lowest of its vertices.
template <typename Put>
std::vector<Index> sort_by_lowest_vertex(const Faces& faces, std::size_t vertices, const Put& put,
                                         const Context& context) {
  return with_corners(faces, [&](const auto& corners) {
    const auto lowest = [&](std::size_t f) { return std::array{std::ranges::min(corners(f))}; };
    return sort_by_vertex(faces.size(), vertices, lowest, put, context);
  });
}

}  // namespace meshgrain
