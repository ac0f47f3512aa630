#pragma once

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

/// Roundings that were made sharp, to be found again: what sharpen_bends() returned.
struct Roundings {
  Mesh triangles;
  double widest = 0;

  void add(const Roundings& more);
};

/// Puts those vertices of a mesh that was made where roundings had been sharpened back onto these.
/// The border stays, and vertices whose faces would be spoilt do.
void round_again(Mesh& mesh, const Roundings& roundings, const Context& context);

}  // namespace meshgrain
