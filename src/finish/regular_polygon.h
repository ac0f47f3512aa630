#pragma once

#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// How a regular polygon is fitted to a face.
struct PolygonFit {
  Vec3 upward;     ///< Along the normal of the surface under the face.
  float side;      ///< That the polygon should have.
  float evenness;  ///< 0: it has the size that fits best; 1: that side.
};

/// For every corner of a face, its place in the regular polygon that fits the face best: the face
/// in its mean plane as complex numbers, of which the first Fourier coefficient is that polygon (in
/// the least-squares sense, with free size and turn). The size is then drawn towards that of a
/// polygon of the given side. A face that has turned over, or nearly, is fitted by a polygon that
/// has not.
void fit_regular_polygon(std::span<const Index> face, const std::vector<Vec3>& positions,
                         const PolygonFit& fit, std::span<Vec3> corners);

}  // namespace meshgrain
