#include "mesh/cut_apart.h"

#include <algorithm>
#include <utility>

#include "mesh/border.h"
#include "mesh/marks.h"
#include "mesh/pair_around_edge.h"
#include "mesh/vertex_faces.h"
#include "util/edge_of.h"
#include "util/sort_unique.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

using Edge = std::array<Index, 2>;

std::vector<Edge> sorted(std::vector<Edge> edges) {
  sort_unique(edges);
  return edges;
}

class Cutting {
 public:
  Cutting(Mesh& mesh, const Context& context)
      : mesh_(mesh),
        edges_(sorted(branch_edges(mesh, context))),
        around_(edges_.empty() ? VertexFaces() : vertex_faces(mesh, context)),
        marks_(edges_.empty() ? std::vector<Edge>() : sorted_marks(mesh)) {}

  Cuts run() {
    Cuts result;
    if (edges_.empty()) return result;
    std::vector<Index> vertices;
    for (const Edge& edge : edges_) vertices.insert(vertices.end(), edge.begin(), edge.end());
    sort_unique(vertices);
    result.sources.resize(mesh_.positions.size());
    for (Index v = 0; v < result.sources.size(); ++v) result.sources[v] = v;
    for (const Index v : vertices) part_fans(v, result.sources);
    const std::vector<Index> faces = faces_of(around_, vertices);
    drop_marks(faces);
    // Corners change last: what meets at an edge is told from the vertices that were.
    const std::vector<Edge> before = edges_of(faces);
    for (const auto& [place, copy] : moves_) mesh_.faces.corners()[place] = copy;
    const std::vector<Edge> after = edges_of(faces);
    std::vector<Edge> marked;
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (std::ranges::binary_search(edges_, before[k])) result.edges.push_back(after[k]);
      if (std::ranges::binary_search(marks_, before[k])) marked.push_back(after[k]);
    }
    sort_unique(result.edges);
    sort_unique(marked);
    mesh_.marked_edges.insert(mesh_.marked_edges.end(), marked.begin(), marked.end());
    return result;
  }

 private:
  /// The faces at v hang together by its other edges, and by pairs at those that are cut. The first
  /// fan of them keeps v.
  void part_fans(Index v, std::vector<Index>& sources) {
    const auto around = around_[v];
    const auto place = [&](Index f) {
      return static_cast<Index>(std::ranges::lower_bound(around, f) - around.begin());
    };
    UnionFind fans(around.size());
    for (const Index w : vertices_of(mesh_, around)) {
      if (w == v) continue;
      std::vector<Index> both;
      std::ranges::set_intersection(around, around_[w], std::back_inserter(both));
      if (std::ranges::binary_search(edges_, edge_of(v, w))) {
        for (const auto& [f, g] : pairs(edge_of(v, w), both)) fans.unite(place(f), place(g));
      } else if (both.size() == 2) {
        fans.unite(place(both[0]), place(both[1]));
      }
    }
    std::vector<Index> vertex(around.size(), no_index);  // of each fan
    vertex[fans.find(0)] = v;
    for (Index k = 0; k < around.size(); ++k) {
      Index& own = vertex[fans.find(k)];
      if (own == no_index) own = copy(v, sources);
      if (own == v) continue;
      const auto face = std::as_const(mesh_.faces)[around[k]];
      moves_.emplace_back(mesh_.faces.first(around[k]) + corner_of(face, v), own);
    }
  }

  std::vector<Edge> pairs(const Edge& edge, const std::vector<Index>& faces) const {
    std::vector<FaceBesideEdge> beside;
    for (const Index f : faces) {
      const auto face = std::as_const(mesh_.faces)[f];
      const std::size_t k = corner_of(face, edge[0]);
      const bool runs_along = face[(k + 1) % 3] == edge[1];
      beside.push_back({mesh_.positions[face[(k + (runs_along ? 2 : 1)) % 3]], runs_along});
    }
    std::vector<Edge> result;
    for (const auto& [i, j] :
         pair_around_edge(mesh_.positions[edge[0]], mesh_.positions[edge[1]], beside)) {
      result.push_back({faces[i], faces[j]});
    }
    return result;
  }

  Index copy(Index v, std::vector<Index>& sources) {
    const auto append = [v](auto& values) {
      if (!values.empty()) values.push_back(values[v]);
    };
    append(mesh_.positions);
    append(mesh_.normals);
    append(mesh_.values);
    sources.push_back(v);
    return static_cast<Index>(sources.size() - 1);
  }

  std::vector<Edge> edges_of(const std::vector<Index>& faces) const {
    std::vector<Edge> result;
    for (const Index f : faces) {
      const auto face = std::as_const(mesh_.faces)[f];
      for (std::size_t k = 0; k < 3; ++k) result.push_back(edge_of(face[k], face[(k + 1) % 3]));
    }
    return result;
  }

  /// Marked edges at vertices that are copied are to be marked anew, as their faces have them.
  void drop_marks(const std::vector<Index>& faces) {
    if (marks_.empty()) return;
    std::vector<Edge> near = edges_of(faces);
    sort_unique(near);
    mesh_.marked_edges.clear();
    for (const Edge& mark : marks_) {
      if (!std::ranges::binary_search(near, mark)) mesh_.marked_edges.push_back(mark);
    }
  }

  Mesh& mesh_;
  const std::vector<Edge> edges_;
  const VertexFaces around_;
  const std::vector<Edge> marks_;
  std::vector<std::pair<std::size_t, Index>> moves_;  // of corners, to copies
};

}  // namespace

Cuts cut_apart(Mesh& triangles, const Context& context) {
  return Cutting(triangles, context).run();
}

void join_again(Mesh& triangles, const Cuts& cuts) {
  if (cuts.empty()) return;
  for (Index& v : triangles.faces.corners()) v = cuts.sources[v];
  std::size_t count = 0;
  while (count < cuts.sources.size() && cuts.sources[count] == count) ++count;
  const auto shorten = [count](auto& values) {
    if (!values.empty()) values.resize(count);
  };
  shorten(triangles.positions);
  shorten(triangles.normals);
  shorten(triangles.values);
  for (auto& [a, b] : triangles.marked_edges) {
    a = cuts.sources[a];
    b = cuts.sources[b];
  }
  triangles.marked_edges = sorted_marks(triangles);
}

}  // namespace meshgrain
