#include "mesh/vertex_faces.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "meshgrain/error.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// A counting sort by vertex: each face comes to those that `vertices_of(f)` lists, `entries` in
/// all. Each range of vertices is one thread's alone, which reads all faces: that is quick, as they
/// come one after the other, and the vertices that it writes do not.
template <typename VerticesOf>
VertexFaces sort_by_vertex(std::size_t faces, std::size_t vertices, std::size_t entries,
                           const VerticesOf& vertices_of, const Context& context) {
  if (entries >= no_index) throw Error("a mesh can have at most 4294967294 face corners");
  VertexFaces result{std::vector<Index>(vertices + 1, 0), std::vector<Index>(entries)};
  std::vector<Index>& offsets = result.offsets;
  constexpr std::size_t most_ranges = 8;
  const auto ranges = std::clamp<std::size_t>(context.threads(), 1, most_ranges);
  const std::size_t grain = std::max<std::size_t>((vertices + ranges - 1) / ranges, 1);
  context.for_ranges(vertices, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = 0; f < faces; ++f) {
      for (const Index v : vertices_of(f)) {
        if (v - begin < end - begin) ++offsets[v];
      }
    }
  });
  // First the ends of each vertex's faces, which move down to the starts as these are filled in.
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  context.for_ranges(vertices, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = faces; f-- > 0;) {
      for (const Index v : vertices_of(f)) {
        if (v - begin < end - begin) result.faces[--offsets[v]] = static_cast<Index>(f);
      }
    }
  });
  return result;
}

}  // namespace

VertexFaces vertex_faces(const Mesh& mesh, const Context& context) {
  const auto corners = [&](std::size_t f) { return mesh.faces[f]; };
  return sort_by_vertex(mesh.faces.size(), mesh.positions.size(), mesh.faces.corners().size(),
                        corners, context);
}

VertexFaces faces_by_lowest_vertex(const Faces& faces, std::size_t vertices,
                                   const Context& context) {
  const auto lowest = [&](std::size_t f) { return std::array{std::ranges::min(faces[f])}; };
  return sort_by_vertex(faces.size(), vertices, faces.size(), lowest, context);
}

std::vector<Index> vertices_of(const Mesh& mesh, std::span<const Index> faces) {
  std::vector<Index> result;
  for (const Index f : faces) {
    result.insert(result.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  }
  sort_unique(result);
  return result;
}

std::vector<Index> with_rings(const Mesh& mesh, const VertexFaces& around, std::vector<Index> faces,
                              int rings) {
  sort_unique(faces);
  for (int ring = 0; ring < rings; ++ring) {
    for (const Index v : vertices_of(mesh, faces)) {
      faces.insert(faces.end(), around[v].begin(), around[v].end());
    }
    sort_unique(faces);
  }
  return faces;
}

}  // namespace meshgrain
