#pragma once

#include <array>
#include <span>
#include <vector>

#include "extract/lattice_mesh.h"
#include "extract/lattice_pieces.h"

namespace meshgrain {

/// Leads the apex of a cone to a triangle that has room for it, where no single change gains
/// anything: over up to three edges, each by a swing (it gets the jump by the other side of the
/// apex), after a flip in the triangle beyond if that makes room.
class ApexLeader {
 public:
  ApexLeader(LatticeMesh& lattice, LatticePieces& pieces)
      : lattice_(lattice), map_(lattice.map), pieces_(pieces) {}

  /// That of the cone left of the edge from one vertex to another. Returns whether there are less
  /// flaws in the end; else all is as it was, but that remade() edges have other numbers.
  bool lead(Index from, Index to);

  /// By the last lead(): the corners of changed triangles, and edges that were flipped and back.
  const std::vector<std::array<Index, 4>>& changed() const { return changed_; }
  const std::vector<Index>& remade() const { return remade_; }

 private:
  /// The ends of an edge. They name it also after it was flipped and back, which makes it another.
  using Ends = std::array<Index, 2>;
  static constexpr Ends no_edge{no_index, no_index};

  /// A swing of `over`, after a flip of `flipped` beside it, if any.
  struct Lead {
    Ends over, flipped;
    double flaws;  // by how much there are more
    double cost;
  };

  Ends ends(Index h) const { return {map_.origin(h), map_.target(h)}; }
  Index halfedge(const Ends& ends) const { return map_.halfedge(ends[0], ends[1]); }

  bool search(Index h, int swings, double flaws_so_far, bool came_over_h);
  /// All that add no more flaws than that.
  void find_over(Index over, double most_flaws, std::vector<Lead>& leads);

  LatticeMesh& lattice_;
  const PolygonMap& map_;
  LatticePieces& pieces_;
  std::vector<std::array<Index, 4>> changed_;
  std::vector<Index> remade_;
};

}  // namespace meshgrain
