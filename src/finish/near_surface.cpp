#include "finish/near_surface.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "measure/face_shape.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

std::vector<Triangle> triangles_in(const Mesh& surface, const BoxCells& cells,
                                   const Context& context) {
  std::vector<std::uint8_t> is_in(surface.positions.size());
  for_indices(
      is_in.size(), [&](Index v) { is_in[v] = cells.contains(surface.positions[v]); }, context);
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Triangle>& out) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = surface.faces[f];
      const Index a = face[0], b = face[1], c = face[2];
      if (is_in[a] | is_in[b] | is_in[c]) out.push_back({a, b, c});
    }
  };
  return collect<Triangle>(surface.faces.size(), look, context);
}

}  // namespace

NearSurface::NearSurface(const Mesh& surface, const BoxCells& cells, const Context& context)
    : tree_(surface.positions, triangles_in(surface, cells, context)),
      normals_(tree_.triangles().size()) {
  const auto find_normal = [&](Index t) {
    normals_[t] = area_vector(tree_.triangles()[t], surface.positions).stableNormalized();
  };
  for_indices(normals_.size(), find_normal, context);
}

NearSurface::Nearest NearSurface::nearest(const Vec3& p, float limit) const {
  const Bvh::Hit hit = tree_.closest(p.cast<double>(), double{limit} * limit);
  if (hit.triangle == no_index) return {limit, Vec3::Zero()};
  return {static_cast<float>(std::sqrt(hit.squared_distance)), normals_[hit.triangle]};
}

}  // namespace meshgrain
