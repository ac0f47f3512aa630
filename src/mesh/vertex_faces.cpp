#include "mesh/vertex_faces.h"

#include <algorithm>
#include <numeric>

#include "meshgrain/error.h"

namespace meshgrain {

VertexFaces vertex_faces(const Mesh& mesh, const Context& context) {
  const std::size_t corners = mesh.faces.corners().size(), count = mesh.positions.size();
  if (corners >= no_index) throw Error("a mesh can have at most 4294967294 face corners");
  VertexFaces result{std::vector<Index>(count + 1, 0), std::vector<Index>(corners)};
  // A counting sort by vertex. Each range of vertices is one thread's alone, which reads all faces:
  // that is quick, as they come one after the other, and the vertices that it writes do not.
  constexpr std::size_t most_ranges = 8;
  const auto ranges = std::clamp<std::size_t>(context.threads(), 1, most_ranges);
  const std::size_t grain = std::max<std::size_t>((count + ranges - 1) / ranges, 1);
  std::vector<Index>& offsets = result.offsets;
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (const Index v : mesh.faces.corners()) {
      if (v - begin < end - begin) ++offsets[v];
    }
  });
  // First the ends of each vertex's faces, which move down to the starts as these are filled in.
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = mesh.faces.size(); f-- > 0;) {
      for (const Index v : mesh.faces[f]) {
        if (v - begin < end - begin) result.faces[--offsets[v]] = static_cast<Index>(f);
      }
    }
  });
  return result;
}

}  // namespace meshgrain
