#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A combinatorial map: a graph with a cyclic order of the edges around each vertex, as halfedges.
/// The walks along `next` ("orbits") are its faces, so that whatever the edges are, every edge has
/// a face on either side. Halfedges h and h ^ 1 are the two sides of an edge.
class PolygonMap {
 public:
  PolygonMap() = default;
  /// The edges around a vertex are ordered by angle in its tangent plane.
  PolygonMap(std::span<const Vec3> positions, std::span<const Vec3> normals,
             std::span<const std::array<Index, 2>> edges);

  /// The faces of a mesh. Edges that are not between two faces of opposite direction are cut: each
  /// side gets a border of its own. A vertex where several fans of faces meet becomes one a fan.
  /// `sources` gets the mesh's vertex of each vertex, `corners` the place in Faces::corners() where
  /// each halfedge starts, or no_index for one outside.
  PolygonMap(const Mesh& mesh, std::vector<Index>& sources, std::vector<Index>& corners,
             const Context& context);

  std::size_t vertices() const { return leaving_.size(); }
  std::size_t halfedges() const { return origin_.size(); }
  bool removed(Index h) const { return origin_[h] == no_index; }
  static Index twin(Index h) { return h ^ 1; }
  Index next(Index h) const { return next_[h]; }
  Index prev(Index h) const { return prev_[h]; }
  Index origin(Index h) const { return origin_[h]; }
  Index target(Index h) const { return origin_[h ^ 1]; }

  /// The next halfedge with the same origin, clockwise around it.
  Index around(Index h) const { return next_[twin(h)]; }
  /// Some halfedge that leaves the vertex, or no_index.
  Index leaving(Index vertex) const { return leaving_[vertex]; }
  /// Calls `body` for each halfedge that leaves the vertex, clockwise; there must be one.
  template <typename Body>
  void for_each_leaving(Index vertex, const Body& body) const {
    const Index start = leaving(vertex);
    Index h = start;
    do {
      body(h);
      h = around(h);
    } while (h != start);
  }
  std::size_t valence(Index vertex) const;
  /// The halfedge from one vertex to another, or no_index.
  Index halfedge(Index from, Index to) const;
  bool adjacent(Index a, Index b) const { return halfedge(a, b) != no_index; }

  /// Calls `body` for the halfedges of h's orbit, from h on.
  template <typename Body>
  void for_orbit(Index h, const Body& body) const {
    Index g = h;
    do {
      body(g);
      g = next_[g];
    } while (g != h);
  }
  std::size_t degree(Index h) const;
  /// The halfedges of h's orbit, from h on.
  void orbit(Index h, std::vector<Index>& out) const;

  /// Takes an edge away: the orbits on its two sides become one (or, if they are the same, two).
  void remove_edge(Index h);
  /// Adds an edge from the origin of `a` to the origin of `b`, two halfedges of one orbit. Returns
  /// the halfedge from the origin of `a`, in whose orbit `b` lies.
  Index add_edge(Index a, Index b);
  /// Merges the target of `h` into its origin; the edge vanishes, and the orbits on its sides lose
  /// it.
  void contract_edge(Index h);
  /// Puts a new vertex on an edge: h then ends there, and the halfedge from there to the old target
  /// is returned. The new vertex has the highest number.
  Index split_edge(Index h);
  /// Cuts the vertex that two halfedges leave in two: the edges from `a` clockwise up to `b` go to
  /// a new vertex, which is returned. If `a` and `b` were in one orbit it becomes two, else theirs
  /// become one.
  Index split_vertex(Index a, Index b);
  /// Drops removed edges and vertices without any, and numbers the rest anew, in their order.
  struct Renumbering {
    std::vector<Index> vertices, edges;  ///< From old to new; no_index if dropped.
    std::size_t vertex_count = 0;
  };
  Renumbering compact();

  /// Puts a new vertex into h's orbit, joined to all of its corners. Returns the vertex.
  Index add_hub(Index h);

 private:
  UninitializedVector<Index> origin_, next_, prev_, leaving_;
};

}  // namespace meshgrain
