#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/extract.h"

namespace meshgrain {

/// Some faces of a mesh that lie together, as a mesh of their own, to be changed and put back.
struct Piece {
  std::vector<Index> faces;          // of the whole mesh, in the order in which they are here
  std::vector<Index> vertices;       // of each vertex here, that of the whole mesh; increasing
  std::vector<std::uint8_t> on_rim;  // of each vertex, whether faces elsewhere have it, too
  Extraction extraction;             // the vertices on the rim are corners: they stay
};

/// The faces within so many rings around one, which comes first. `around`: those of the whole mesh.
Piece cut_piece(const Extraction& whole, const VertexFaces& around, Index face, int rings);

/// The whole mesh with `changed` in the place of a piece; vertices that this leaves without faces
/// are still there (see drop_unused). `sources`: of each vertex of `changed` that of the piece if
/// it is on the rim, else no_index.
Extraction put_back(const Extraction& whole, const Piece& piece, const Extraction& changed,
                    std::span<const Index> sources);

}  // namespace meshgrain
