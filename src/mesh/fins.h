#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshgrain/mesh.h"

namespace meshgrain {

/// A face, and an earlier one with the same corners in the same or reverse order.
struct EqualFaces {
  Index later, earlier;
};

/// Of faces that lie back to back, those to take away on both sides, sorted: small fins that stand
/// on a surface that is whole without them, as programs leave that simplify meshes. A sheet with
/// two sides stands by itself, and a large fin is meant to be one. `equal`: all there are, those
/// with the same corners one behind the other.
std::vector<Index> find_fins(const Mesh& mesh, std::span<const EqualFaces> equal);

}  // namespace meshgrain
