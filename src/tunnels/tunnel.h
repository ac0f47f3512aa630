#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/mesh.h"
#include "tunnels/sleeve.h"

namespace meshgrain {

/// Tells what loops on a surface go around, and how far that reaches.
class TunnelSearch {
 public:
  /// All must outlive this; the cutter may go on.
  TunnelSearch(const Mesh& triangles, const VertexFaces& around, const SleeveCutter& cutter);

  enum class Kind {
    hollow,  ///< With the solid around it.
    handle   ///< Around the solid, and short as well.
  };
  /// What is to be cut out around a loop if it goes around a tunnel of that kind, and the rest of
  /// the surface stays connected; of a hollow one as far as it is about as narrow, if that shows.
  /// `longest`: how long loops may be.
  std::optional<Sleeve> sleeve_around(const std::vector<Index>& loop, Kind kind, double longest);

 private:
  using Faces = std::vector<Index>;
  enum Side : std::uint8_t { left, right };
  static constexpr std::array both{left, right};

  bool is_on_loop(Index v) const { return place_[v] != no_index; }
  bool is_in_loop(Index a, Index b) const;
  Index across(Index f, Index a, Index b) const;
  template <typename Body>
  void each_across(Index f, const Body& body) const;

  bool find_sides();
  bool are_sides_connected();
  bool is_hollow() const;
  bool has_way_around(double longest);
  Faces faces_at_loop();
  Faces faces_in_tunnel(const Faces& at_loop);
  bool mark_banks(const Faces& at_loop);

  /// Marks a face or a vertex. Returns false if it has a mark.
  bool mark(Index which, Side side);
  bool is_marked(Index which) const { return round_of_[which] == round_; }

  const Mesh& mesh_;
  const VertexFaces& around_;
  const SleeveCutter& cutter_;
  bool is_inside_out_ = false;
  std::vector<Index> loop_;
  double length_ = 0;                      // of the loop
  std::vector<Index> place_;               // of each vertex in the loop, or no_index
  std::array<Faces, 2> sides_;             // beside edges of the loop
  std::uint32_t round_ = 0;                // of marks, either of faces or of vertices
  std::vector<std::uint32_t> round_of_;    // in which each was last marked
  std::vector<Side> side_of_;              // then
  std::vector<std::uint8_t> was_reached_;  // of each vertex, by faces_in_tunnel()
};

}  // namespace meshgrain
