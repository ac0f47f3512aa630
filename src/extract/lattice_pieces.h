#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "extract/lattice_mesh.h"

namespace meshgrain {

/// A triangle of a lattice mesh as it is or as it might become. A corner that is not there yet has
/// no index.
struct LatticePiece {
  std::array<Index, 3> corners;
  LatticeTriangle lattice;
};

/// Of all of them, or at least what is more than `limit`.
double flaws(std::span<const LatticePiece> pieces,
             double limit = std::numeric_limits<double>::infinity());

/// What changes of a lattice mesh would make of its triangles, before they are made.
class LatticePieces {
 public:
  explicit LatticePieces(const LatticeMesh& lattice) : lattice_(lattice), map_(lattice.map) {}

  /// The triangle left of h, from h's origin on.
  LatticePiece piece(Index h) const {
    return {{map_.origin(h), map_.target(h), map_.target(map_.next(h))}, lattice_.triangle(h)};
  }
  /// The ends of an edge, and the corners of the triangles left and right of it.
  std::array<Index, 4> corners(Index h) const {
    const Index t = PolygonMap::twin(h);
    return {map_.origin(h), map_.origin(t), map_.origin(map_.prev(h)), map_.origin(map_.prev(t))};
  }

  /// The two triangles that LatticeMesh::flip(h) leaves: by the origin of h, and by its target.
  std::array<LatticePiece, 2> flipped(Index h) const;
  /// By how much, squared, that makes the edge shorter.
  double shortening(Index h) const {
    return lattice_.squared_length(h) -
           lattice_.metric().squared_length(lattice_.flipped_jump(h).t);
  }
  /// The jump against h by way of the other two edges of its triangle: another one in a cone, whose
  /// apex is beyond h then.
  Jump the_other_way(Index h) const {
    return composed(lattice_.jump(map_.next(h)), lattice_.jump(map_.prev(h)), lattice_.posy);
  }

  /// The triangles left and right of h once it has that jump.
  std::array<LatticePiece, 2> swung(Index h) const;

  /// What LatticeMesh::shift(v, t) makes of a triangle that is given from its corner v on.
  LatticePiece shifted(LatticePiece piece, const std::array<int, 2>& t) const;

  /// The triangles around the target of h once that is at h's origin.
  void collapsed(Index h, std::vector<LatticePiece>& pieces) const;

  /// Whether every vertex keeps its angle in the lattice when some triangles take the place of
  /// others, or gets the one that it should have. Else a star could come to go around twice though
  /// none of its triangles is turned over. `gone` is not looked at.
  bool keep_angles(std::span<const LatticePiece> before, std::span<const LatticePiece> after,
                   Index gone = no_index);

 private:
  struct Change {
    Index vertex;
    double angle;
  };

  const LatticeMesh& lattice_;
  const PolygonMap& map_;
  std::vector<Change> changes_;
};

}  // namespace meshgrain
