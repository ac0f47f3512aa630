#pragma once

#include "meshgrain/mesh.h"
#include "util/union_find.h"

namespace meshgrain {

/// The vertices of each piece of a mesh that hangs together by its faces, as one set.
inline UnionFind pieces_of(const Mesh& mesh) {
  UnionFind pieces(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (const Index v : face) pieces.unite(face[0], v);
  }
  return pieces;
}

}  // namespace meshgrain
