#pragma once

#include <cstddef>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

struct OrientReport {
  std::size_t turned_faces = 0;
  /// Pieces without two sides, as a Möbius strip: along a short curve their faces still disagree.
  std::size_t one_sided_pieces = 0;
  /// False where every edge is used as often in one direction as in the other, as in what is
  /// closed.
  bool may_have_border = true;
};

/// Turns faces to the side of their neighbours, in pieces that hang together by edges between two
/// faces. Pieces that agree already stay as they are. Others get the side of most of their area; or
/// where that is not clear, as after a shuffle of all faces, the outer one. No face may come to a
/// vertex twice.
OrientReport orient_faces(Mesh& mesh, const Context& context = Context(1));

}  // namespace meshgrain
