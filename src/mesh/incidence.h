#pragma once

#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// The faces around each vertex, in increasing order.
struct Incidence {
  std::vector<Index> offsets;  // vertices + 1
  std::vector<Index> faces;

  std::span<const Index> operator[](std::size_t vertex) const {
    return {faces.data() + offsets[vertex], offsets[vertex + 1] - offsets[vertex]};
  }
};

Incidence incident_faces(const Faces& faces, std::size_t vertices);

}  // namespace meshgrain
