#include "finish/near_surface.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "finish/face_shape.h"

namespace meshgrain {
NearSurface::NearSurface(Mesh part) : part_(std::move(part)), tree_(part_) {
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
