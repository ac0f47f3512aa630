#pragma once

#include "measure/bvh.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// A part of a surface, for finding the nearest of all of its sides there. A Projector knows one
/// side alone, but needs no tree.
class NearSurface {
 public:
  /// `part`: of triangles.
  explicit NearSurface(Mesh part);
  NearSurface(const NearSurface&) = delete;
  NearSurface& operator=(const NearSurface&) = delete;

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
