#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "meshgrain/uninitialized.h"

namespace meshgrain {

/// Faces by vertices, those of each in increasing order.
struct VertexFaces {
  std::vector<Index> offsets;  ///< One more than there are vertices.
  UninitializedVector<Index> faces;

  std::span<const Index> operator[](std::size_t v) const {
    return {faces.data() + offsets[v], offsets[v + 1] - offsets[v]};
  }
};

/// The faces around each vertex; a face that repeats a vertex appears as often. Throws Error if the
/// mesh has more corners than an index can count.
VertexFaces vertex_faces(const Mesh& mesh, const Context& context = Context(1));

/// Which of a face's corners is v; their number if none is.
inline std::size_t corner_of(std::span<const Index> face, Index v) {
  return static_cast<std::size_t>(std::ranges::find(face, v) - face.begin());
}

/// Whether two lists in increasing order, such as of the faces around vertices, have any in common.
bool share_any(std::span<const Index> a, std::span<const Index> b);

/// The vertices of some faces, in increasing order.
std::vector<Index> vertices_of(const Mesh& mesh, std::span<const Index> faces);

/// The faces around some vertices, in increasing order.
std::vector<Index> faces_of(const VertexFaces& around, std::span<const Index> vertices);

/// Some faces with so many rings of others around them, in increasing order.
std::vector<Index> with_rings(const Mesh& mesh, const VertexFaces& around, std::vector<Index> faces,
                              int rings);

}  // namespace meshgrain
