#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "extract/drop_unused.h"
#include "extract/mean_vertex.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/finish.h"

namespace meshgrain {
namespace {

/// The undirected edges of all faces, each with the corners (positions in Faces::corners) that
/// start it, sorted.
struct CornerEdge {
  Index low, high, face, corner;
  auto key() const { return std::pair(low, high); }
};

std::vector<CornerEdge> corner_edges(const Faces& faces) {
  std::vector<CornerEdge> edges;
  edges.reserve(faces.corners().size());
  for (Index f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k], b = face[(k + 1) % face.size()];
      edges.push_back({std::min(a, b), std::max(a, b), f, static_cast<Index>(faces.first(f) + k)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const CornerEdge& a, const CornerEdge& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return edges;
}

/// Lets line edges and corners follow vertices that faces have copies of now; those that no face
/// has any more go. `source`: what each vertex is a copy of, or itself.
void follow_copies(Extraction& extraction, const std::vector<Index>& source) {
  using Ends = std::pair<Index, Index>;
  const auto ordered = [](Index a, Index b) { return Ends(std::min(a, b), std::max(a, b)); };
  std::multimap<Ends, LineEdge> lines;
  for (const LineEdge& edge : extraction.line_edges) lines.emplace(ordered(edge.a, edge.b), edge);
  extraction.line_edges.clear();
  const Faces& faces = extraction.mesh.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k], b = face[(k + 1) % face.size()];
      const auto [begin, end] = lines.equal_range(ordered(source[a], source[b]));
      for (auto it = begin; it != end; ++it) {
        const bool ahead = source[a] == it->second.a;
        extraction.line_edges.push_back({ahead ? a : b, ahead ? b : a, it->second.line});
      }
    }
  }
  // Edges between two faces were met twice.
  const auto key = [](const LineEdge& e) { return std::tuple(e.line, e.a, e.b); };
  std::ranges::sort(extraction.line_edges, {}, key);
  const auto twice = std::ranges::unique(extraction.line_edges, {}, key);
  extraction.line_edges.erase(twice.begin(), twice.end());

  std::vector<Index> corners = std::exchange(extraction.corners, {});
  std::ranges::sort(corners);
  for (Index v = 0; v < source.size(); ++v) {
    if (std::ranges::binary_search(corners, source[v])) extraction.corners.push_back(v);
  }
}

/// Whether each vertex is one where pieces of the surface meet: its place on the input is on one of
/// them, and says nothing about the others.
std::vector<std::uint8_t> meeting_vertices(const std::vector<CornerEdge>& edges,
                                           std::size_t vertices) {
  std::vector<std::uint8_t> result(vertices, 0);
  for (std::size_t e = 2; e < edges.size(); ++e) {
    if (edges[e].key() == edges[e - 2].key()) result[edges[e].low] = result[edges[e].high] = 1;
  }
  return result;
}

}  // namespace

void split_into_quads(Extraction& extraction) {
  Mesh& mesh = extraction.mesh;
  const Faces faces = std::move(mesh.faces);
  std::vector<Index> middle(faces.corners().size());  // of the edge that starts at each corner
  const auto edges = corner_edges(faces);
  const auto meets = meeting_vertices(edges, mesh.positions.size());
  const auto one_piece_first = [&](std::span<Index> some) {
    const auto first = std::ranges::find_if(some, [&](Index v) { return !meets[v]; });
    if (first != some.end()) std::ranges::rotate(some, first);
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (e > 0 && edges[e].key() == edges[e - 1].key()) {
      middle[edges[e].corner] = middle[edges[e - 1].corner];
    } else {
      Index ends[2] = {edges[e].low, edges[e].high};
      one_piece_first(ends);
      middle[edges[e].corner] = append_mean(extraction, ends);
    }
  }
  std::vector<LineEdge> halves;
  for (const auto& [a, b, line] : extraction.line_edges) {
    const auto it = std::lower_bound(
        edges.begin(), edges.end(), std::pair(std::min(a, b), std::max(a, b)),
        [](const CornerEdge& e, const std::pair<Index, Index>& key) { return e.key() < key; });
    if (it == edges.end() || it->key() != std::pair(std::min(a, b), std::max(a, b))) continue;
    halves.push_back({a, middle[it->corner], line});
    halves.push_back({middle[it->corner], b, line});
  }
  extraction.line_edges = std::move(halves);
  mesh.faces = Faces();
  mesh.faces.reserve(faces.corners().size(), 4 * faces.corners().size());
  std::vector<Index> corners;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    corners.assign(face.begin(), face.end());
    one_piece_first(corners);
    const Index center = append_mean(extraction, corners);
    const std::size_t first = faces.first(f), n = face.size();
    for (std::size_t k = 0; k < n; ++k) {
      mesh.faces.push_back({face[k], middle[first + k], center, middle[first + (k + n - 1) % n]});
    }
  }
}

void take_dual(Extraction& extraction) {
  const Mesh& mesh = extraction.mesh;
  Extraction dual;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    Vec3 sum = Vec3::Zero(), normal = Vec3::Zero();
    for (const Index v : face) {
      sum += mesh.positions[v];
      if (!mesh.normals.empty()) normal += mesh.normals[v];
    }
    dual.mesh.positions.push_back(sum / static_cast<float>(face.size()));
    if (!mesh.normals.empty()) {
      const float length = normal.norm();
      dual.mesh.normals.push_back(length > 0 ? Vec3(normal / length) : mesh.normals[face[0]]);
    }
    dual.nodes.push_back(extraction.nodes[face[0]]);
  }
  const VertexFaces around = vertex_faces(mesh);
  std::vector<Index> ring;
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    // Walk around the vertex: after face f comes the one that has f's edge into v as its edge out.
    const auto corner = [&](Index f) { return corner_of(mesh.faces[f], v); };
    const auto next_of = [&](Index f) {
      const auto face = mesh.faces[f];
      const Index from = face[(corner(f) + face.size() - 1) % face.size()];
      for (const Index g : around[v]) {
        const auto other = mesh.faces[g];
        if (other[(corner(g) + 1) % other.size()] == from) return g;
      }
      return no_index;
    };
    if (around[v].size() < 3) continue;
    ring.clear();
    Index f = around[v][0];
    do {
      ring.push_back(f);
      f = next_of(f);
    } while (f != no_index && f != ring[0] && ring.size() <= around[v].size());
    if (f == ring[0] && ring.size() == around[v].size()) dual.mesh.faces.push_back(ring);
  }
  dual.mesh.origin = mesh.origin;
  extraction = std::move(dual);
  drop_unused(extraction);
}

std::size_t make_manifold(Extraction& extraction) {
  Mesh& mesh = extraction.mesh;
  // Faces are let in one after the other; one that meets an edge already used in its direction
  // would be the third on it, or turned over.
  std::map<std::pair<Index, Index>, Index> used;  // directed edge -> face
  Faces kept;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = std::as_const(mesh.faces)[f];
    const std::size_t n = face.size();
    bool free = true;
    for (std::size_t k = 0; k < n && free; ++k) free = !used.contains({face[k], face[(k + 1) % n]});
    if (!free) continue;
    for (std::size_t k = 0; k < n; ++k) {
      used[{face[k], face[(k + 1) % n]}] = static_cast<Index>(kept.size());
    }
    kept.push_back(face);
  }
  const std::size_t dropped = mesh.faces.size() - kept.size();
  mesh.faces = std::move(kept);

  // One vertex a fan: faces around a vertex that share an edge there belong to the same.
  const std::size_t vertices = mesh.positions.size();
  const VertexFaces around = vertex_faces(mesh);
  std::vector<Index> source(vertices);  // of copies: the vertex
  std::iota(source.begin(), source.end(), Index{0});
  std::vector<Index> fan;
  for (Index v = 0; v < vertices; ++v) {
    const auto faces = around[v];
    fan.resize(faces.size());
    std::iota(fan.begin(), fan.end(), Index{0});
    const auto find = [&](Index i) {
      while (fan[i] != i) i = fan[i];
      return i;
    };
    const auto spokes = [&](Index f) {
      const auto face = std::as_const(mesh.faces)[f];
      const auto k = corner_of(face, v);
      return std::pair(face[(k + 1) % face.size()], face[(k + face.size() - 1) % face.size()]);
    };
    for (Index a = 0; a < faces.size(); ++a) {
      for (Index b = 0; b < a; ++b) {
        const auto [a1, a2] = spokes(faces[a]);
        const auto [b1, b2] = spokes(faces[b]);
        if (a1 == b2 || a2 == b1) fan[find(a)] = find(b);
      }
    }
    std::vector<std::pair<Index, Index>> copies;  // fan -> vertex
    for (Index a = 0; a < faces.size(); ++a) {
      const Index root = find(a);
      if (root == find(0)) continue;
      auto it = std::find_if(copies.begin(), copies.end(),
                             [&](const auto& copy) { return copy.first == root; });
      if (it == copies.end()) {
        const Index self[1] = {v};
        copies.emplace_back(root, append_mean(extraction, self));
        source.push_back(v);
        it = copies.end() - 1;
      }
      for (Index& corner : mesh.faces[faces[a]]) {
        if (corner == v) corner = it->second;
      }
    }
  }
  if (dropped > 0 || source.size() > vertices) follow_copies(extraction, source);
  drop_unused(extraction);
  return dropped;
}

}  // namespace meshgrain
