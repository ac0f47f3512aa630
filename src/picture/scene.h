#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/triangles.h"
#include "meshgrain/context.h"
#include "meshgrain/picture.h"

namespace meshgrain::picture {

/// A mesh as the eye sees it, and what of it gets drawn. All lengths are in pixels of the image; x
/// runs to the right, y down and z towards the eye.
struct Scene {
  std::vector<Vec3> points;         ///< The mesh's vertices.
  std::vector<Triangle> triangles;  ///< Empty for a point cloud.
  std::vector<Index> face_of;       ///< The face of each triangle.
  std::vector<Vec3> normals;  ///< One a triangle corner; or one a point, or none, for a cloud.
  const Faces* faces = nullptr;

  std::vector<std::int8_t> irregular;  ///< Per vertex: -1 fewer neighbours, 1 more; or empty.
  /// Per vertex: the other ends of (two of) its border edges, or no_index; or empty.
  std::vector<std::array<Index, 2>> border_neighbours;
  std::size_t regular_face = 0;  // corners of the faces that are not tinted; 0: none is

  float line_width = 0;     ///< 0 draws no edges.
  float line_strength = 0;  ///< Opacity of the edges: less where they are dense on the whole.
  float border_width = 0;   ///< 0 draws no borders.
  float dot_radius = 0;     ///< Of irregular vertices, and of the points of a cloud.
};

Scene make_scene(const Mesh& mesh, const PictureOptions& options, const Context& context);

}  // namespace meshgrain::picture
