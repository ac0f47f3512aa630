#pragma once

#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The faces around each vertex, in increasing order; a face that repeats a vertex appears as
/// often.
struct VertexFaces {
  std::vector<Index> offsets;  ///< One more than there are vertices.
  std::vector<Index> faces;

  std::span<const Index> operator[](std::size_t v) const {
    return {faces.data() + offsets[v], offsets[v + 1] - offsets[v]};
  }
};

VertexFaces vertex_faces(const Mesh& mesh, const Context& context = Context());

}  // namespace meshgrain
