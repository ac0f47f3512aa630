#include "finish/crossing_guard.h"

#include <algorithm>
#include <utility>

#include "finish/crossings.h"

namespace meshgrain {

CrossingGuard::CrossingGuard(Mesh& mesh, std::span<const Index> faces, const Context& context)
    : mesh_(mesh),
      context_(context),
      part_(part_of(mesh, faces)),
      crossings_(find_crossings(part_.mesh, context)) {}

void CrossingGuard::undo_new() {
  const std::vector<Vec3> last = part_.mesh.positions;
  for (std::size_t k = 0; k < part_.vertices.size(); ++k) {
    part_.mesh.positions[k] = mesh_.positions[part_.vertices[k]];
  }
  if (part_.mesh.positions == last) return;
  std::vector<std::array<Index, 2>> crossings;
  for (bool changed = true; changed;) {
    changed = false;
    crossings = find_crossings(part_.mesh, context_);
    for (const auto& pair : crossings) {
      if (std::ranges::binary_search(crossings_, pair)) continue;
      for (const Index f : pair) {
        for (const Index v : std::as_const(part_.mesh.faces)[f]) {
          changed = changed || part_.mesh.positions[v] != last[v];
          part_.mesh.positions[v] = last[v];
        }
      }
    }
  }
  crossings_ = std::move(crossings);
  for (std::size_t k = 0; k < part_.vertices.size(); ++k) {
    mesh_.positions[part_.vertices[k]] = part_.mesh.positions[k];
  }
}

}  // namespace meshgrain
