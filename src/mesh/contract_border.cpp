#include "mesh/contract_border.h"

#include <algorithm>

#include "mesh/border.h"
#include "meshgrain/clean.h"
#include "util/union_find.h"

namespace meshgrain {

std::size_t contract_border(Mesh& mesh, std::vector<std::array<Index, 2>>& border,
                            const Context& context) {
  const auto has_no_length = [&](const std::array<Index, 2>& edge) {
    return mesh.positions[edge[0]] == mesh.positions[edge[1]];
  };
  if (std::ranges::none_of(border, has_no_length)) return 0;
  UnionFind merged(mesh.positions.size());
  std::size_t count = 0;
  for (const auto& edge : border) count += has_no_length(edge) && merged.unite(edge[0], edge[1]);
  for (Index& v : mesh.faces.corners()) v = merged.find(v);
  for (auto& edge : mesh.marked_edges) edge = {merged.find(edge[0]), merged.find(edge[1])};
  clean(mesh, context);  // faces beside these edges, and the vertices
  border = border_edges(mesh, context);
  return count;
}

}  // namespace meshgrain
