#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A part of a surface around a tunnel, or around a handle, between two rims.
struct Sleeve {
  std::vector<Index> faces;              // increasing
  std::vector<std::vector<Index>> rims;  // the vertices along both, as its faces go around
};

/// What is left of a surface of triangles while sleeves are cut out of it.
class SleeveCutter {
 public:
  /// Both must outlive this.
  SleeveCutter(const Mesh& triangles, const VertexFaces& around);

  /// Makes a sleeve of some faces around a loop, and of others in notches of its rims. Nothing if
  /// that does not give two rims that do not touch themselves or a sleeve that was cut out, or if
  /// one is longer than that.
  std::optional<Sleeve> sleeve_of(std::vector<Index> faces, double longest_rim) const;

  /// No vertex of it can be in another one.
  void cut_out(const Sleeve& sleeve);
  bool was_cut_out(Index face) const { return is_out_[face] != 0; }
  bool is_taken(Index vertex) const { return is_taken_[vertex] != 0; }

 private:
  using Halfedge = std::array<Index, 2>;

  Index beyond(const std::vector<Index>& faces, const Halfedge& edge) const;
  std::vector<Halfedge> rim_of(const std::vector<Index>& faces) const;
  void fill_notches(std::vector<Index>& faces) const;

  const Mesh& mesh_;
  const VertexFaces& around_;
  std::vector<std::uint8_t> is_out_;    // of each face
  std::vector<std::uint8_t> is_taken_;  // of each vertex
};

}  // namespace meshgrain
