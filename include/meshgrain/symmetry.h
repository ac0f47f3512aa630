#pragma once

#include <array>
#include <cstddef>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Planes about which a result is to be exactly symmetric, in its connectivity and its positions.
struct Symmetry {
  std::array<bool, 3> axes{};  ///< Planes across x, y and z.
  bool automatic = false;      ///< Or the one of the three that suits the input best, if any.

  bool any() const { return automatic || axes[0] || axes[1] || axes[2]; }
};

/// A plane across an axis.
struct MirrorPlane {
  int axis = 0;
  double offset = 0;    ///< Along the axis, relative to Mesh::origin.
  double mismatch = 0;  ///< Mean distance of the surface to its mirror image, over its diagonal.
  double unlike = 0;    ///< The share of the surface that is farther from it than 0.02 of that.
};

/// The plane across an axis about which a mesh is most nearly symmetric, among those through the
/// middle of its bounding box and the centre of its area.
MirrorPlane find_mirror_plane(const Mesh& mesh, int axis, const Context& context = Context());

/// Moves Mesh::origin onto the plane (exactly along its axis), and cuts what lies below it off.
/// Vertices hardly off the plane move onto it, and faces in it are dropped.
void cut_at(Mesh& triangles, const MirrorPlane& plane);

/// How many faces lie in a plane.
std::size_t count_faces_in(const Mesh& mesh, const MirrorPlane& plane);

/// Adds the mirror image about the plane through Mesh::origin across `axis`. Vertices of the border
/// less than `near` from it move onto it, and belong to both halves. Values are left out.
void add_mirror_image(Mesh& mesh, int axis, double near);

}  // namespace meshgrain
