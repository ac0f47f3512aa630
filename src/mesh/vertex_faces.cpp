#include "mesh/vertex_faces.h"

#include <algorithm>
#include <atomic>

#include "meshgrain/error.h"

namespace meshgrain {

VertexFaces vertex_faces(const Mesh& mesh, const Context& context) {
  const std::size_t vertices = mesh.positions.size();
  const std::span<const Index> corners = mesh.faces.corners();
  if (corners.size() >= no_index) throw Error("a mesh can have at most 4294967294 face corners");

  // A counting sort by vertex. The threads place faces as they come; sorting each vertex's few
  // afterwards makes the order the same for any number of threads.
  VertexFaces result{std::vector<Index>(vertices + 1, 0), std::vector<Index>(corners.size())};
  constexpr std::size_t grain = 8192;
  context.for_ranges(corners.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      std::atomic_ref(result.offsets[corners[c]]).fetch_add(1, std::memory_order_relaxed);
  });
  Index sum = 0;
  for (Index& offset : result.offsets) offset = sum += offset;  // the end of each vertex's faces

  context.for_ranges(mesh.faces.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for (const Index v : mesh.faces[f]) {
        std::atomic_ref place(result.offsets[v]);
        result.faces[place.fetch_sub(1, std::memory_order_relaxed) - 1] = static_cast<Index>(f);
      }
  });
  context.for_ranges(vertices, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      std::sort(result.faces.begin() + result.offsets[v],
                result.faces.begin() + result.offsets[v + 1]);
  });
  return result;
}

}  // namespace meshgrain
