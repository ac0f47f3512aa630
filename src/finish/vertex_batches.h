#pragma once

#include <span>
#include <vector>

#include "mesh/vertex_faces.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Parts vertices into batches in which no two share a face, so that all of one can be moved at
/// once, whatever that does to their faces.
class VertexBatches {
 public:
  /// Both must outlive this.
  VertexBatches(const Mesh& mesh, const VertexFaces& around)
      : mesh_(mesh), around_(around), batch_(mesh.positions.size(), no_index) {}

  /// None of the vertices twice. Each goes into the first batch where it shares no face.
  std::vector<std::vector<Index>> operator()(std::span<const Index> vertices);

 private:
  const Mesh& mesh_;
  const VertexFaces& around_;
  std::vector<Index> batch_;  // of each vertex, while they are parted
};

}  // namespace meshgrain
