#include "finish/crossing_guard.h"

#include <algorithm>
#include <utility>

#include "finish/crossings.h"
#include "mesh/vertex_faces.h"

namespace meshgrain {

CrossingGuard::CrossingGuard(Mesh& mesh, const std::vector<Index>& faces, const Context& context)
    : mesh_(mesh), context_(context), vertices_(vertices_of(mesh, faces)) {
  for (const Index v : vertices_) part_.positions.push_back(mesh.positions[v]);
  std::vector<Index> corners;
  for (const Index f : faces) {
    corners.clear();
    for (const Index v : std::as_const(mesh.faces)[f]) {
      const auto at = std::ranges::lower_bound(vertices_, v) - vertices_.begin();
      corners.push_back(static_cast<Index>(at));
    }
    part_.faces.push_back(corners);
  }
  crossings_ = find_crossings(part_, context_);
}

void CrossingGuard::undo_new() {
  const std::vector<Vec3> last = part_.positions;
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    part_.positions[k] = mesh_.positions[vertices_[k]];
  }
  if (part_.positions == last) return;
  std::vector<std::array<Index, 2>> crossings;
  for (bool changed = true; changed;) {
    changed = false;
    crossings = find_crossings(part_, context_);
    for (const auto& pair : crossings) {
      if (std::ranges::binary_search(crossings_, pair)) continue;
      for (const Index f : pair) {
        for (const Index v : std::as_const(part_.faces)[f]) {
          changed = changed || part_.positions[v] != last[v];
          part_.positions[v] = last[v];
        }
      }
    }
  }
  crossings_ = std::move(crossings);
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    mesh_.positions[vertices_[k]] = part_.positions[k];
  }
}

}  // namespace meshgrain
