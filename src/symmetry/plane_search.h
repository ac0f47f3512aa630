#pragma once

#include <Eigen/Geometry>

#include "measure/bvh.h"
#include "measure/surface_sampler.h"
#include "meshgrain/symmetry.h"

namespace meshgrain {

/// find_mirror_plane() for several axes of a mesh, which must outlive this.
class PlaneSearch {
 public:
  PlaneSearch(const Mesh& mesh, const Context& context);

  MirrorPlane find(int axis, const Context& context) const;

 private:
  MirrorPlane measure(int axis, double offset, const Context& context) const;
  MirrorPlane measure(int axis, double offset, std::size_t step, const Context& context) const;

  const Mesh& mesh_;
  Eigen::AlignedBox3f box_;
  SurfaceSampler samples_;
  Bvh tree_;
};

}  // namespace meshgrain
