#pragma once

#include <array>
#include <span>
#include <vector>

#include "finish/crossing_pairs.h"
#include "mesh/part.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Keeps some of the faces of a mesh, while its vertices are moved, from passing through each other
/// where they did not before.
class CrossingGuard {
 public:
  /// The mesh and the context must outlive this.
  CrossingGuard(Mesh& mesh, std::span<const Index> faces, const Context& context);
  CrossingGuard(const CrossingGuard&) = delete;
  CrossingGuard& operator=(const CrossingGuard&) = delete;

  /// Puts the vertices of faces that pass through others, and did not at the last call, back to
  /// where they were then.
  void undo_new();

 private:
  Mesh& mesh_;
  Part part_;  // those faces
  CrossingPairs crossings_;
};

}  // namespace meshgrain
