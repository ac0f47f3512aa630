#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "mesh/next_corners.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Sets of vertices of a triangle mesh, its places, each of which is to become one vertex
/// elsewhere. Triangles with two vertices of a place are of it, and go with it; the others are
/// sides.
class VertexMerging {
 public:
  struct Place {
    std::vector<Index> members;  ///< In increasing order; the first stands for all.
    Vec3 at = Vec3::Zero();
    bool may_go = true;
  };

  /// A triangle at a member of a place, its two other corners in order.
  struct Corner {
    Index member, from, to, face;
  };

  /// The mesh must outlive this.
  VertexMerging(const Mesh& triangles, const Context& context);

  /// The members must be in no other place.
  void add_place(std::vector<Index> members);
  std::vector<Place>& places() { return places_; }
  const std::vector<Place>& places() const { return places_; }
  /// Which of them has a vertex, or no_index.
  Index place_of(Index v) const { return place_of_[v]; }
  static bool has(const Place& place, Index v) {
    return std::ranges::binary_search(place.members, v);
  }

  const VertexFaces& around() const { return around_; }
  bool is_on_rim(Index v) const { return on_rim_[v] != 0; }
  Vec3 normal(const Corner& corner) const;
  bool is_side(const Corner& corner) const {
    return !are_of_one_place(corner.member, corner.from) &&
           !are_of_one_place(corner.from, corner.to) && !are_of_one_place(corner.to, corner.member);
  }

  template <typename Body>
  void for_each_corner(std::span<const Index> members, const Body& body) const {
    for (const Index v : members) {
      for (const Index f : around_[v]) {
        const auto [from, to] = next_corners(mesh_.faces[f].data(), v);
        body(Corner{v, from, to, f});
      }
    }
  }

  template <typename Body>
  void for_each_side(const Place& place, const Body& body) const {
    for_each_corner(place.members, [&](const Corner& corner) {
      if (is_side(corner)) body(corner);
    });
  }

  /// Of pairs of triangles, one after the other, at edges from members to others.
  template <typename Body>
  void for_each_fold(const Place& place, const Body& body) const {
    std::map<std::array<Index, 2>, const Corner> next;  // by the edges that they follow
    for_each_corner(place.members, [&](const Corner& corner) {
      next.emplace(std::array{corner.member, corner.from}, corner);
    });
    for_each_corner(place.members, [&](const Corner& corner) {
      if (!has(place, corner.to)) body(corner, next.at({corner.member, corner.to}));
    });
  }

  /// What a vertex will be part of, when all have gone that may, and where.
  Index into(Index v) const;
  const Vec3& position_to_be(Index v) const;
  bool will_have_area(const Corner& corner) const;
  Vec3 normal_to_be(const Corner& corner) const;

  /// Whether its own edges and triangles make up a disk, or a path.
  bool is_disk(const Place& place) const;
  /// Places stay around which the mesh would not be manifold as it is now. Returns whether any do.
  bool leave_what_ties_knots();
  /// Whether sides will look where they do, and what leads from them to places that stay nearly.
  bool turns_no_side(const Place& place) const;

  /// Leaves a copy of the mesh triangles without area, which clean() takes out.
  void merge(Mesh& copy) const;

 private:
  bool are_of_one_place(Index v, Index w) const {
    return place_of_[v] != no_index && place_of_[v] == place_of_[w];
  }
  const Place* place_that_goes(Index v) const;
  bool has_one_ring(std::span<const Index> members) const;

  const Mesh& mesh_;
  VertexFaces around_;
  std::vector<std::uint8_t> on_rim_;
  std::vector<Index> place_of_;
  std::vector<Place> places_;
};

}  // namespace meshgrain
