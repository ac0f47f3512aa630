#include "extract/drop_unused.h"

#include <utility>

namespace meshgrain {

void drop_unused(Extraction& extraction) {
  Mesh& mesh = extraction.mesh;
  std::vector<Index> rank(mesh.positions.size(), no_index);
  for (const Index v : std::as_const(mesh.faces).corners()) rank[v] = 0;
  Index count = 0;
  for (Index v = 0; v < rank.size(); ++v) {
    if (rank[v] == no_index) continue;
    rank[v] = count;
    mesh.positions[count] = mesh.positions[v];
    if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[v];
    extraction.nodes[count] = extraction.nodes[v];
    ++count;
  }
  mesh.positions.resize(count);
  if (!mesh.normals.empty()) mesh.normals.resize(count);
  extraction.nodes.resize(count);
  for (Index& v : mesh.faces.corners()) v = rank[v];
  for (LineEdge& edge : extraction.line_edges) edge = {rank[edge.a], rank[edge.b], edge.line};
  std::erase_if(extraction.line_edges,
                [](const LineEdge& e) { return e.a == no_index || e.b == no_index; });
  for (Index& v : extraction.corners) v = rank[v];
  std::erase(extraction.corners, no_index);
}

}  // namespace meshgrain
