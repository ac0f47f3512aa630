#include "mesh/edges.h"

#include <algorithm>

namespace meshgrain {

std::vector<Edge> edges_of(const Mesh& mesh) {
  const Faces& faces = mesh.faces;
  const auto for_each_side = [&](auto&& visit) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto face = faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) {
        const Index a = face[c], b = face[c + 1 < face.size() ? c + 1 : 0];
        if (a != b) visit(std::min(a, b), std::max(a, b));
      }
    }
  };
  // Sort the sides into one bucket for each lesser vertex.
  std::vector<std::size_t> end(mesh.positions.size() + 1, 0);
  for_each_side([&](Index a, Index) { ++end[a + 1]; });
  for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  std::vector<Index> greater(end.back());
  for_each_side([&](Index a, Index b) { greater[end[a]++] = b; });  // end[a] is now a's end

  std::vector<Edge> edges;
  edges.reserve(greater.size() / 2 + greater.size() / 16);
  std::size_t begin = 0;
  for (std::size_t a = 0; a < mesh.positions.size(); begin = end[a++]) {
    std::sort(greater.begin() + begin, greater.begin() + end[a]);
    for (std::size_t i = begin; i < end[a]; ++i)
      if (i > begin && greater[i] == greater[i - 1])
        ++edges.back().uses;
      else
        edges.push_back({static_cast<Index>(a), greater[i], 1});
  }
  return edges;
}

VertexDegrees vertex_degrees(const Mesh& mesh, const std::vector<Edge>& edges) {
  VertexDegrees degrees;
  degrees.neighbours.assign(mesh.positions.size(), 0);
  degrees.border.assign(mesh.positions.size(), 0);
  for (const Edge& edge : edges) {
    ++degrees.neighbours[edge.a];
    ++degrees.neighbours[edge.b];
    if (edge.uses != 2) degrees.border[edge.a] = degrees.border[edge.b] = 1;
  }
  degrees.regular_face = regular_face_degree(mesh.faces);
  degrees.regular = degrees.regular_face == 3 ? 6 : degrees.regular_face == 6 ? 3 : 4;
  return degrees;
}

Index regular_face_degree(const Faces& faces) {
  std::size_t triangles = 0, hexagons = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    triangles += faces.degree(f) == 3;
    hexagons += faces.degree(f) == 6;
  }
  if (10 * triangles > 9 * faces.size()) return 3;
  return 2 * hexagons > faces.size() ? 6 : 4;
}

}  // namespace meshgrain
