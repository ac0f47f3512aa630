#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meshgrain/extract.h"

namespace meshgrain {

/// A row of quads across opposite edges, from border to border or around, with the edges between
/// them and at its ends: one more than there are faces if it is open.
struct QuadStrip {
  std::vector<Index> faces;
  std::vector<Index> rungs;  // the corner (place in Faces::corners()) where each edge starts
  float width = 0;           // mean length of a rung
  float narrowest = 0;       // the least one
};

/// The strips of a mesh of quads.
class QuadStrips {
 public:
  /// Two vertices, the lower one first.
  using Edge = std::array<Index, 2>;

  /// The extraction must outlive this.
  explicit QuadStrips(const Extraction& extraction);

  /// All of at most so many faces, the narrowest first, but for those that pass through an edge of
  /// more than two faces.
  std::vector<QuadStrip> up_to(std::size_t most) const;

  Edge ends(Index corner) const;
  bool is_border(Index corner) const { return opposite_[corner] == no_index; }
  bool on_line(const Edge& edge) const;

  bool is_border_vertex(Index v) const { return on_border_[v]; }
  /// Whether an edge of more than two faces ends there.
  bool is_branch_vertex(Index v) const { return on_branch_[v]; }
  /// How a vertex is held (Hold) by lines: the border is one even where no feature says so.
  std::uint8_t hold(Index v) const { return hold_[v]; }
  std::size_t valence(Index v) const { return valence_[v]; }

 private:
  void find_opposites();
  QuadStrip follow(Index start) const;

  const Mesh& mesh_;
  std::vector<Index> edges_;      // one corner of each, by its lower end, then by its higher one
  std::vector<Index> opposite_;   // of each corner: where the same edge starts in the other face
  std::vector<Edge> line_edges_;  // sorted
  std::vector<std::uint8_t> hold_;
  std::vector<std::size_t> valence_;
  std::vector<std::uint8_t> on_border_, on_branch_;
};

}  // namespace meshgrain
