#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// A face beside an edge: where its other corners are, and whether it runs along the edge in the
/// edge's own direction (then the face is on its left, seen from outside).
struct FaceBesideEdge {
  Vec3 corner;
  bool runs_along;
};

/// Which faces stay together where the surface is cut along an edge of more than two, as pairs
/// (that runs along, that runs against). If there are as many of both, those between which the
/// inside of a solid lies: solids that touch come apart, and none gets a border (Guéziec et al.
/// 2001, "Cutting and Stitching", pair faces by their angles as well). Else those that lie
/// flattest, as where a wall stands on a floor; the others are left over.
std::vector<std::array<std::size_t, 2>> pair_around_edge(const Vec3& from, const Vec3& to,
                                                         std::span<const FaceBesideEdge> faces);

}  // namespace meshgrain
