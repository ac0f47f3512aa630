#include "extract/line_edges.h"

namespace meshgrain {

std::vector<std::uint8_t> held_vertices(const Extraction& extraction) {
  std::vector<std::uint8_t> hold(extraction.mesh.positions.size(), free_vertex);
  for (const LineEdge& edge : extraction.line_edges) hold[edge.a] = hold[edge.b] = on_line;
  for (const Index v : extraction.corners) hold[v] = at_corner;
  return hold;
}

}  // namespace meshgrain
