#include "finish/crossing_guard.h"

#include <algorithm>
#include <utility>

namespace meshgrain {

CrossingGuard::CrossingGuard(Mesh& mesh, std::span<const Index> faces, const Context& context)
    : mesh_(mesh), part_(part_of(mesh, faces)), crossings_(part_.mesh, context) {}

void CrossingGuard::undo_new() {
  std::vector<Vec3>& positions = part_.mesh.positions;
  const std::vector<Vec3> last = positions;
  const std::vector<std::array<Index, 2>> allowed = crossings_.all();
  for (std::size_t k = 0; k < part_.vertices.size(); ++k) {
    positions[k] = mesh_.positions[part_.vertices[k]];
  }
  while (crossings_.update()) {
    for (const auto& pair : crossings_.all()) {
      if (std::ranges::binary_search(allowed, pair)) continue;
      for (const Index f : pair) {
        for (const Index v : std::as_const(part_.mesh.faces)[f]) positions[v] = last[v];
      }
    }
  }
  for (std::size_t k = 0; k < part_.vertices.size(); ++k) {
    mesh_.positions[part_.vertices[k]] = positions[k];
  }
}

}  // namespace meshgrain
