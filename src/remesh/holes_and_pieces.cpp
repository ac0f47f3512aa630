#include "remesh/holes_and_pieces.h"

#include "graph/pieces.h"

namespace meshgrain {

std::vector<double> piece_areas(const Graph& graph, const Context& context) {
  SharedUnionFind pieces = pieces_of(graph, context);
  std::vector<Index> number(graph.size());
  std::vector<double> areas;
  for (Index i = 0; i < graph.size(); ++i) {
    const Index first = pieces.find(i);  // the lowest of its piece
    if (first == i) {
      number[i] = static_cast<Index>(areas.size());
      areas.push_back(0);
    }
    areas[number[first]] += graph.areas[i];
  }
  return areas;
}

double share_of_holes(const Graph& graph, std::size_t triangles, double faces,
                      const Context& context) {
  constexpr double faces_a_hole = 14, faces_a_piece = 24;  // measured
  const auto pieces = static_cast<double>(piece_areas(graph, context).size());
  const auto vertices = static_cast<double>(graph.size());
  const auto edges = static_cast<double>(graph.neighbors.size() / 2);
  const double euler = vertices - edges + static_cast<double>(triangles);
  const double holes = 2 * pieces - euler;  // a handle counts as two
  return (faces_a_hole * holes + faces_a_piece * (pieces - 1)) / faces;
}

}  // namespace meshgrain
