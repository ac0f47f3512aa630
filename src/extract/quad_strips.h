#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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

/// How many strips to change before all are looked for again, if so many were changed already: one
/// after the other for as long as that takes little time.
inline std::size_t strips_at_once(std::size_t changed) {
  constexpr std::size_t few = 16;
  return std::max<std::size_t>(1, changed / few);
}

/// Strips that do not touch each other.
class StripsApart {
 public:
  /// No more than `most` of them.
  StripsApart(const Mesh& mesh, std::size_t most)
      : mesh_(mesh), touched_(mesh.positions.size(), 0), left_(most) {}

  bool are_enough() const { return left_ == 0; }

  /// Takes in a strip, if no vertex of the faces that it changes is one of those of others.
  bool add(const std::vector<Index>& faces) {
    const auto is_touched = [&](Index f) {
      return std::ranges::any_of(mesh_.faces[f], [&](Index v) { return touched_[v] != 0; });
    };
    if (left_ == 0 || std::ranges::any_of(faces, is_touched)) return false;
    for (const Index f : faces) {
      for (const Index v : mesh_.faces[f]) touched_[v] = 1;
    }
    --left_;
    return true;
  }

 private:
  const Mesh& mesh_;
  std::vector<std::uint8_t> touched_;
  std::size_t left_;
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
