#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/triangles.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Points all over a surface: one in every strip of an equal share of the area. Of a cloud, or a
/// surface without area: its vertices, if need be only so many.
class SurfaceSampler {
 public:
  /// Keeps a reference to the mesh's positions.
  SurfaceSampler(const Mesh& mesh, std::size_t samples);

  std::size_t size() const { return samples_; }
  Eigen::Vector3d operator[](std::size_t i) const;

 private:
  Eigen::Vector3d at(Index v) const { return positions_[v].cast<double>(); }

  const std::vector<Vec3>& positions_;
  std::vector<Triangle> triangles_;
  std::vector<double> area_up_to_;
  std::size_t samples_;
};

}  // namespace meshgrain
