#pragma once

#include <vector>

#include "measure/bvh.h"
#include "mesh/box_cells.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A part of a surface, for finding the nearest of all of its sides there. A Projector knows one
/// side alone, but needs no tree.
class NearSurface {
 public:
  /// The triangles with a corner in one of the cells; none of a point cloud. The surface must
  /// outlive this.
  NearSurface(const Mesh& surface, const BoxCells& cells, const Context& context);

  struct Nearest {
    float distance;
    Vec3 normal;  // of the triangle there; zero if it has no area, or if there is none
  };
  /// The point of the surface nearest to `p`, if it is nearer than `limit`.
  Nearest nearest(const Vec3& p, float limit) const;

 private:
  Bvh tree_;
  std::vector<Vec3> normals_;  // of its triangles
};

}  // namespace meshgrain
