#include "mesh/marks.h"

#include "util/edge_of.h"
#include "util/sort_unique.h"

namespace meshgrain {

std::vector<std::array<Index, 2>> sorted_marks(const Mesh& mesh) {
  std::vector<std::array<Index, 2>> marks = mesh.marked_edges;
  std::erase_if(marks, [](const auto& edge) { return edge[0] == edge[1]; });
  for (auto& edge : marks) edge = edge_of(edge[0], edge[1]);
  sort_unique(marks);
  return marks;
}

}  // namespace meshgrain
