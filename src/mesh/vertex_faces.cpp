#include "mesh/vertex_faces.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "meshgrain/error.h"

namespace meshgrain {
namespace {

// Both are counting sorts by vertex: `offsets` are first the ends of each vertex's faces, then
// move down to the starts as they are filled.

void place_in_order(const Mesh& mesh, VertexFaces& result) {
  for (const Index v : mesh.faces.corners()) ++result.offsets[v];
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  for (std::size_t f = mesh.faces.size(); f-- > 0;) {
    for (const Index v : mesh.faces[f]) result.faces[--result.offsets[v]] = static_cast<Index>(f);
  }
}

/// The threads place faces as they come; sorting each vertex's few afterwards makes the order the
/// same for any number of threads.
void place_in_parallel(const Mesh& mesh, VertexFaces& result, const Context& context) {
  constexpr std::size_t grain = 8192;
  const std::span<const Index> corners = mesh.faces.corners();
  context.for_ranges(corners.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      std::atomic_ref(result.offsets[corners[c]]).fetch_add(1, std::memory_order_relaxed);
  });
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  context.for_ranges(mesh.faces.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for (const Index v : mesh.faces[f]) {
        std::atomic_ref place(result.offsets[v]);
        result.faces[place.fetch_sub(1, std::memory_order_relaxed) - 1] = static_cast<Index>(f);
      }
  });
  context.for_ranges(mesh.positions.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      std::sort(result.faces.begin() + result.offsets[v],
                result.faces.begin() + result.offsets[v + 1]);
  });
}

}  // namespace

VertexFaces vertex_faces(const Mesh& mesh, const Context& context) {
  const std::size_t corners = mesh.faces.corners().size();
  if (corners >= no_index) throw Error("a mesh can have at most 4294967294 face corners");
  VertexFaces result{std::vector<Index>(mesh.positions.size() + 1, 0), std::vector<Index>(corners)};
  constexpr int many = 8;  // what atomics and sorting cost takes that many threads to win back
  if (context.threads() < many) {
    place_in_order(mesh, result);
  } else {
    place_in_parallel(mesh, result, context);
  }
  return result;
}

}  // namespace meshgrain
