#pragma once

#include <array>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// The pairs of faces that pass through each other, of a mesh whose vertices are moved: only those
/// of faces that did are looked at again.
class CrossingPairs {
 public:
  /// The mesh and the context must outlive this.
  CrossingPairs(const Mesh& mesh, const Context& context);

  /// As of the last update. The lower number first, in increasing order.
  const std::vector<std::array<Index, 2>>& all() const { return pairs_; }

  /// Returns whether any vertex had moved.
  bool update();

 private:
  const Mesh& mesh_;
  const Context& context_;
  std::vector<Vec3> positions_;  // at the last update
  std::vector<std::array<Index, 2>> pairs_;
};

}  // namespace meshgrain
