#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Looks for short loops on a surface that no disk of it fills: around tunnels, handles and limbs.
class LoopSearch {
 public:
  /// Both must outlive this.
  LoopSearch(const Mesh& triangles, const VertexFaces& around);

  /// The vertices along some of them that pass within `distance` of a vertex, among these the
  /// shortest if it is not longer than `longest`. Each starts at the end of one of the two shortest
  /// paths that it is made of. (Erickson and Whittlesey 2005, Greedy optimal homotopy and homology
  /// generators, on what lies within `distance` and half of `longest`.)
  std::vector<std::vector<Index>> near(Index vertex, double distance, double longest);

  /// Some of the places, so that every one of them is within a distance of one of these. Those that
  /// no face uses are left out.
  std::vector<Index> thinned_out(std::span<const Index> places, double distance);

 private:
  /// An edge that no shortest path takes, and the faces beside it.
  struct Chord {
    double loop;  // the length of the loop that it closes
    std::array<Index, 2> ends;
    std::array<Index, 2> sides;  // numbers of faces
  };

  void reach_from(Index start, double farthest);
  bool is_reached(Index v) const { return round_of_[v] == round_; }
  /// Of the edges between vertices that were reached. All that lies farther off counts as one face,
  /// the first.
  std::vector<Chord> chords();
  Index number_of(Index face);
  std::vector<Index> loop_of(const Chord& chord) const;

  const Mesh& mesh_;
  const VertexFaces& around_;
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> round_of_;  // in which a vertex was last reached
  std::vector<double> distance_;
  std::vector<Index> before_;                 // on the shortest path
  std::vector<Index> reached_;                // all of this round
  std::vector<std::uint32_t> round_of_face_;  // in which a face last got its number
  std::vector<Index> number_of_face_;
  Index faces_ = 0;  // with a number: all corners were reached; and what lies farther off
};

}  // namespace meshgrain
