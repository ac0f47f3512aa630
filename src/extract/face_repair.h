#pragma once

#include <span>
#include <vector>

#include "extract/clusters.h"
#include "extract/polygon_map.h"

namespace meshgrain {

/// Turns the orbits of a map into the faces that a position field of symmetry `posy` asks for:
/// triangles for 6, mostly quads for 4.
class FaceRepair {
 public:
  /// `holes`: a flag for each halfedge, whether its orbit is open.
  FaceRepair(PolygonMap& map, Clusters& clusters, int posy, std::vector<std::uint8_t> holes);

  // For faces that were found by walking around a graph (face_repair.cpp).

  /// Removes edges that have the same orbit on both sides: dangling ones and bridges.
  void remove_dangling();

  /// Cuts vertices at which an orbit touches itself, and closes the orbits of two edges that this
  /// can leave: every orbit is then a simple polygon.
  void cut_pinches();

  /// Marks orbits as open: those that run along the border of the surface (`border_edges`: one flag
  /// an edge; `border_vertices`), and what is longer than `largest_gap`.
  void find_holes(std::span<const std::uint8_t> border_edges,
                  std::span<const std::uint8_t> border_vertices, std::size_t largest_gap);

  // Triangles (triangle_repair.cpp).

  /// Triangles only: contracts edges much shorter than the target, which lead to clusters of very
  /// few nodes (the spurious ones of section 3.8) or hold two vertices of one lattice point apart.
  void contract_short_edges(const EdgeLength& edge_length, const std::vector<float>& cover);

  /// Triangles only: turns edges where that mends an inverted triangle or a needle.
  void flip_bad_triangles();

  /// Triangles only: where triangles are still turned over, moves their vertex into the middle of
  /// its neighbours or contracts it into one of them, whichever leaves the best triangles.
  void untangle();

  // Quads (quad_repair.cpp).

  /// Removes interior vertices with two edges, which no regular mesh has.
  void remove_doublets();

  /// Quads: removes the edges between pairs of triangles that the lattice has as a square's
  /// diagonal
  /// (`jumps`: one an edge), the best squares first.
  void remove_diagonals(std::span<const std::array<int, 2>> jumps);

  /// Quads: takes edges away, or turns them within the two faces beside them, as long as that
  /// leaves fewer irregular faces and vertices, the greatest gain first. So pairs of triangles
  /// become quads, and the long side of a flat triangle makes way for a T-junction.
  void improve_edges();

  /// Quads: closes faces by merging two opposite corners as long as that leaves fewer irregular
  /// vertices.
  void close_quads();

  /// Triangles: turns the edge between two of them as long as that leaves fewer irregular vertices.
  void flip_edges();

  /// Splits faces with more corners than the symmetry allows along their best chords. A face of a
  /// 6-PoSy that no chord can split, as its corners are joined outside of it already, gets a vertex
  /// in its middle.
  void split_large();

  bool is_hole(Index h) const { return hole_[h]; }

 private:
  double corner_angle(Index h) const;
  double angle(Index v, Index from, Index to) const;
  double polygon_cost(std::span<const Index> corners) const;
  bool same_orbit(Index a, Index b) const;
  struct EdgeChange {
    int gain = 0;            // by how much the number of irregular faces and vertices falls
    double cost = 0;         // how irregular the new faces are
    Index h = no_index;      // of the edge to take away
    int from = -1, to = -1;  // corners of the union, for an edge in its place; -1: none
  };
  EdgeChange best_change(Index h) const;
  void apply(const EdgeChange& change);
  /// Whether a vertex is irregular for quads once it has `change` more edges.
  bool is_irregular(Index vertex, int change) const;
  /// The halfedges around the two faces of an edge, without it.
  std::vector<Index> union_halfedges(Index h) const;
  /// How far from regular the face would be that an edge leaves when it goes.
  double removal_cost(Index h) const;
  /// By how much the number of irregular vertices falls if the origin of h and the corner opposite
  /// to it in their quad become one; 0 if they must not.
  int closing_gain(Index h) const;
  int flip_gain(Index h) const;
  bool split_once(Index h);
  double triangle_quality(Index a, Index b, Index c) const;
  double star_quality(Index vertex) const;
  double contracted_quality(Index h) const;
  void contract(Index h);
  void add_hub(Index h);
  void cut(Index a, Index b);

  PolygonMap& map_;
  Clusters& clusters_;
  int posy_;
  std::vector<std::uint8_t> hole_;  // one flag a halfedge
};

}  // namespace meshgrain
