#include "finish/untangle.h"

#include <vector>

#include "util/sort_unique.h"

namespace meshgrain {

void untangle(const Mesh& mesh, const VertexFaces& around, LocalSearch& search, int sweeps,
              const Context& context) {
  constexpr float wanted = 0.75f;  // quality below which a face is looked at
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    std::vector<Index> vertices;
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      if (search.quality(f) >= wanted) continue;
      for (const Index v : mesh.faces[f]) {  // the neighbours must make room
        for (const Index g : around[v]) {
          vertices.insert(vertices.end(), mesh.faces[g].begin(), mesh.faces[g].end());
        }
      }
    }
    sort_unique(vertices);
    if (!search.improve(vertices, 1, context)) return;
  }
}

}  // namespace meshgrain
