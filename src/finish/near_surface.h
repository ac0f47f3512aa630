#pragma once

#include "finish/box_cells.h"
#include "measure/bvh.h"
#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// What of a surface lies in the cells of a few places, for finding the nearest of all of its sides
/// there. A Projector knows one side alone, but needs no tree.
class NearSurface {
 public:
  /// `surface`: of triangles smaller than the cells.
  NearSurface(const Mesh& surface, const BoxCells& cells, const Context& context);

  struct Nearest {
    float distance;
    Vec3 normal;  // of the triangle there; zero if it has no area, or if there is none
  };
  /// The point of the surface nearest to `p`, if it is nearer than `limit`.
  Nearest nearest(const Vec3& p, float limit) const;

 private:
  Mesh part_;
  std::vector<Vec3> normals_;  // of its triangles
  Bvh tree_;
};

}  // namespace meshgrain
