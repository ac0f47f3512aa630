#include "shapes/patches.h"

#include <cmath>

namespace meshgrain::shapes {

void add_quad(Mesh& mesh, Index a, Index b, Index c, Index d) {
  const auto& p = mesh.positions;
  const float ac = (p[a] - p[c]).norm(), bd = (p[b] - p[d]).norm();
  // Where both are as long, rounding must not decide: all such quads are split alike.
  if (bd < 0.999f * ac) {
    mesh.faces.push_back({a, b, d});
    mesh.faces.push_back({b, c, d});
  } else {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
  }
}

std::size_t PatchBuilder::CellHash::operator()(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (std::int32_t x : cell)
    hash = (hash ^ static_cast<std::uint32_t>(x)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
  return hash;
}

Index PatchBuilder::new_vertex(const Vec3& p) {
  mesh_.positions.push_back(p);
  return static_cast<Index>(mesh_.positions.size() - 1);
}

Index PatchBuilder::shared_vertex(const Vec3& p) {
  // Far above the rounding of single precision, far below the finest patch. Coinciding vertices
  // fall into the same cell or into two that touch.
  constexpr float tolerance = 5e-6f;
  Cell home;
  for (int k = 0; k < 3; ++k) home[k] = static_cast<std::int32_t>(std::floor(p[k] / tolerance));
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const auto found = border_.find({home[0] + dx, home[1] + dy, home[2] + dz});
        if (found != border_.end()) return found->second;
      }
  const Index v = new_vertex(p);
  border_.emplace(home, v);
  return v;
}

}  // namespace meshgrain::shapes
