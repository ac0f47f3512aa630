#include "mesh/contract_border.h"

#include "mesh/border.h"
#include "meshgrain/clean.h"
#include "util/union_find.h"

namespace meshgrain {

std::size_t contract_border(Mesh& mesh, const Context& context) {
  auto edges = border_edges(mesh, context);
  std::erase_if(
      edges, [&](const auto& edge) { return mesh.positions[edge[0]] != mesh.positions[edge[1]]; });
  if (edges.empty()) return 0;
  UnionFind merged(mesh.positions.size());
  std::size_t count = 0;
  for (const auto& [a, b] : edges) count += merged.unite(a, b);
  for (Index& v : mesh.faces.corners()) v = merged.find(v);
  for (auto& edge : mesh.marked_edges) edge = {merged.find(edge[0]), merged.find(edge[1])};
  clean(mesh, context);  // faces beside these edges, and the vertices
  return count;
}

}  // namespace meshgrain
