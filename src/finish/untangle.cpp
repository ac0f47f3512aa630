#include "finish/untangle.h"

#include <vector>

#include "util/sort_unique.h"

namespace meshgrain {
namespace {

class Untangling {
 public:
  Untangling(const Mesh& mesh, const VertexFaces& around, Placement& placement, LocalSearch& search,
             const Context& context)
      : faces_(mesh.faces),
        around_(around),
        placement_(placement),
        search_(search),
        context_(context) {}

  void run() {
    improve_bad_faces();
    if (release_vertices()) improve_bad_faces();  // a face before a feature
  }

 private:
  static constexpr float wanted = 0.75f;      // quality below which a face is looked at
  static constexpr float acceptable = 0.15f;  // below which its vertices leave their features

  void improve_bad_faces() {
    constexpr int sweeps = 30;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      std::vector<Index> vertices;
      for (Index f = 0; f < faces_.size(); ++f) {
        if (search_.quality(f) >= wanted) continue;
        for (const Index v : faces_[f]) {  // the neighbours must make room
          for (const Index g : around_[v]) {
            vertices.insert(vertices.end(), faces_[g].begin(), faces_[g].end());
          }
        }
      }
      sort_unique(vertices);
      if (!search_.improve(vertices, 1, context_)) return;
    }
  }

  bool release_vertices() {
    bool any = false;
    for (Index f = 0; f < faces_.size(); ++f) {
      if (search_.quality(f) >= acceptable) continue;
      for (const Index v : faces_[f]) {
        if (!placement_.release(v)) continue;
        search_.touch(v);
        any = true;
      }
    }
    return any;
  }

  const Faces& faces_;
  const VertexFaces& around_;
  Placement& placement_;
  LocalSearch& search_;
  const Context& context_;
};

}  // namespace

void untangle(const Mesh& mesh, const VertexFaces& around, Placement& placement,
              LocalSearch& search, const Context& context) {
  Untangling(mesh, around, placement, search, context).run();
}

}  // namespace meshgrain
