#pragma once

#include <span>
#include <vector>

#include "meshgrain/fields.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// How regular polygons are fitted to faces.
struct PolygonFit {
  float side = 1;      ///< That the polygons should have, times the relative size of the face.
  float evenness = 0;  ///< 0: each has the size that fits best; 1: that side.
  const EdgeLength& relative_size;  ///< One for all, or one a vertex.
};

/// For every corner of some faces, its place in the regular polygon that fits the face best: the
/// face in its mean plane as complex numbers, of which the first Fourier coefficient is that
/// polygon (in the least-squares sense, with free size and turn). The size is then drawn towards
/// that of a polygon of the given side. A face that has turned over, or nearly, is fitted by a
/// polygon that has not.
///
/// `which` are faces with equally many corners; `normals` are those of the surface at the vertices;
/// `places` are written beside Faces::corners(). Faces that are turned over, reflex or have an edge
/// without length are appended to `folded`.
void fit_regular_polygons(const Mesh& mesh, std::span<const Index> which,
                          const std::vector<Vec3>& normals, const PolygonFit& fit,
                          std::vector<Vec3>& places, std::vector<Index>& folded);

}  // namespace meshgrain
