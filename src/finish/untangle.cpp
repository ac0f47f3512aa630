#include "finish/untangle.h"

#include <vector>

#include "util/index_marks.h"

namespace meshgrain {

void untangle(const Mesh& mesh, const VertexFaces& around, LocalSearch& search, int sweeps,
              const Context& context) {
  constexpr float wanted = 0.75f;  // quality below which a face is looked at
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    IndexMarks marks;
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      if (search.quality(f) >= wanted) continue;
      for (const Index v : mesh.faces[f]) {  // the neighbours must make room
        for (const Index g : around[v]) {
          for (const Index w : mesh.faces[g]) marks.set(w);
        }
      }
    }
    std::vector<Index> vertices;
    for (Index v = marks.first(0); v != no_index; v = marks.first(v + 1)) vertices.push_back(v);
    if (!search.improve(vertices, 1, context)) return;
  }
}

}  // namespace meshgrain
