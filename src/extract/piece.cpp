#include "extract/piece.h"

#include <algorithm>
#include <array>
#include <utility>

#include "mesh/part.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using Edges = std::vector<std::array<Index, 2>>;

}  // namespace

Piece cut_piece(const Extraction& whole, const VertexFaces& around, Index face, int rings) {
  const Mesh& mesh = whole.mesh;
  Piece piece;
  const std::vector<Index> increasing = with_rings(mesh, around, {face}, rings);
  piece.faces = increasing;
  const auto first = std::ranges::find(piece.faces, face);
  std::rotate(piece.faces.begin(), first, first + 1);
  const Part here = part_of(mesh, piece.faces);
  piece.vertices = here.vertices;
  for (const Index v : piece.vertices) {
    piece.on_rim.push_back(!std::ranges::includes(increasing, around[v]));
  }

  Extraction& part = piece.extraction;
  part.mesh = here.mesh;
  Edges edges;
  for (std::size_t f = 0; f < piece.faces.size(); ++f) {
    const auto corners = here.mesh.faces[f];
    for (std::size_t k = 0; k < corners.size(); ++k) {
      edges.push_back(edge_of(corners[k], corners[(k + 1) % corners.size()]));
    }
  }
  sort_unique(edges);
  for (Index v = 0; v < piece.vertices.size(); ++v) {
    part.mesh.normals.push_back(mesh.normals[piece.vertices[v]]);
    part.nodes.push_back(whole.nodes[piece.vertices[v]]);
    if (piece.on_rim[v]) part.corners.push_back(v);
  }
  for (const Index corner : whole.corners) {
    const Index v = here.number(corner);
    if (v != no_index && !piece.on_rim[v]) part.corners.push_back(v);
  }
  for (const LineEdge& edge : whole.line_edges) {
    const LineEdge e{here.number(edge.a), here.number(edge.b), edge.line};
    if (e.a == no_index || e.b == no_index) continue;
    if (std::ranges::binary_search(edges, edge_of(e.a, e.b))) part.line_edges.push_back(e);
  }
  return piece;
}

Extraction put_back(const Extraction& whole, const Piece& piece, const Extraction& changed,
                    std::span<const Index> sources) {
  Extraction result = whole;
  Mesh& mesh = result.mesh;
  std::vector<Index> vertex;  // of each of `changed`, that of the result
  for (std::size_t v = 0; v < sources.size(); ++v) {
    if (sources[v] != no_index) {
      vertex.push_back(piece.vertices[sources[v]]);
      continue;
    }
    vertex.push_back(static_cast<Index>(mesh.positions.size()));
    mesh.positions.push_back(changed.mesh.positions[v]);
    mesh.normals.push_back(changed.mesh.normals[v]);
    result.nodes.push_back(changed.nodes[v]);
  }
  for (const Index v : changed.corners) {
    if (sources[v] == no_index) result.corners.push_back(vertex[v]);
  }

  Edges replaced;
  for (const auto& [a, b, line] : piece.extraction.line_edges) {
    replaced.push_back(edge_of(piece.vertices[a], piece.vertices[b]));
  }
  sort_unique(replaced);
  std::erase_if(result.line_edges, [&](const LineEdge& e) {
    return std::ranges::binary_search(replaced, edge_of(e.a, e.b));
  });
  for (const auto& [a, b, line] : changed.line_edges) {
    result.line_edges.push_back({vertex[a], vertex[b], line});
  }

  std::vector<std::uint8_t> goes(whole.mesh.faces.size(), 0);
  for (const Index f : piece.faces) goes[f] = 1;
  mesh.faces = Faces();
  for (Index f = 0; f < goes.size(); ++f) {
    if (!goes[f]) mesh.faces.push_back(whole.mesh.faces[f]);
  }
  std::vector<Index> corners;
  for (std::size_t f = 0; f < changed.mesh.faces.size(); ++f) {
    corners.clear();
    for (const Index v : changed.mesh.faces[f]) corners.push_back(vertex[v]);
    mesh.faces.push_back(corners);
  }
  return result;
}

}  // namespace meshgrain
