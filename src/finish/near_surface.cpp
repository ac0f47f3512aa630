#include "finish/near_surface.h"

#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <utility>

#include "finish/face_shape.h"
#include "util/collect.h"

namespace meshgrain {
namespace {

/// The triangles with a corner in one of the cells.
Mesh part_in(const Mesh& surface, const BoxCells& cells, const Context& context) {
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
    for (auto t = static_cast<Index>(begin); t < end; ++t) {
      const auto is_in = [&](Index v) { return cells.contains(surface.positions[v]); };
      if (std::ranges::any_of(surface.faces[t], is_in)) out.push_back(t);
    }
  };
  const std::vector<Index> kept = collect<Index>(surface.faces.size(), look, context);
  Mesh part;
  std::vector<Index> renumbered(surface.positions.size(), no_index);
  for (const Index t : kept) {
    Index corners[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = surface.faces[t][k];
      if (renumbered[v] == no_index) {
        renumbered[v] = static_cast<Index>(part.positions.size());
        part.positions.push_back(surface.positions[v]);
      }
      corners[k] = renumbered[v];
    }
    part.faces.push_back(corners);
  }
  return part;
}

}  // namespace

NearSurface::NearSurface(const Mesh& surface, const BoxCells& cells, const Context& context)
    : part_(part_in(surface, cells, context)), tree_(part_) {
  normals_.reserve(part_.faces.size());
  for (Index t = 0; t < part_.faces.size(); ++t) {
    normals_.push_back(
        area_vector(std::as_const(part_.faces)[t], part_.positions).stableNormalized());
  }
}

NearSurface::Nearest NearSurface::nearest(const Vec3& p, float limit) const {
  const Bvh::Hit hit = tree_.closest(p.cast<double>(), double{limit} * limit);
  if (hit.triangle == no_index) return {limit, Vec3::Zero()};
  return {static_cast<float>(std::sqrt(hit.squared_distance)), normals_[hit.triangle]};
}

}  // namespace meshgrain
