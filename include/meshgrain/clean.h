#pragma once

#include <cstddef>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// What clean() took out.
struct CleanReport {
  /// Corners equal to the one before them in their face, and those between two equal ones.
  std::size_t repeated_corners = 0;
  /// Fewer than three corners after that, or twice the same edge in the same direction.
  std::size_t degenerate_faces = 0;
  /// The corners of an earlier face, in the same or reverse order.
  std::size_t duplicate_faces = 0;
  /// Of small fins: two sides with the same corners, on a surface that is whole without them.
  std::size_t fin_faces = 0;
  std::size_t unused_vertices = 0;   ///< Of no face that is left.
  std::size_t duplicate_points = 0;  ///< Point clouds only: at the position of an earlier point.
  std::size_t loose_marks = 0;       ///< Marked edges that are edges of no face that is left.

  bool any() const {
    return repeated_corners + degenerate_faces + duplicate_faces + fin_faces + unused_vertices +
               duplicate_points + loose_marks >
           0;
  }
};

/// Removes, in linear time, what carries no surface, and says how much there was of it. The order
/// of what is left stays, and normals and values follow their vertices. Marked edges are then
/// sorted, the smaller index first, and each there once. Does not weld vertices.
/// Which `context` it is run in makes no difference to the result.
CleanReport clean(Mesh& mesh, const Context& context = Context(1));

/// Removes pieces of less area (squared input units), but never the largest, and returns their
/// number. Pieces are faces that hang together by shared vertices. Order and attributes as above.
std::size_t drop_small_pieces(Mesh& mesh, double least_area);

}  // namespace meshgrain
