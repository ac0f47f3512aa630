#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include "meshgrain/mesh.h"

namespace meshgrain::made {

/// Negative inside.
using Volume = std::function<double(const Eigen::Vector3d&)>;

/// The surface of a volume within [-1, 1]³, as marching tetrahedra finds it: from the values at the
/// corners of so many cells along each side alone, so that what is sharp is cut off in each cell.
inline Mesh sampled_on_grid(const Volume& volume, int cells) {
  using Corner = std::array<int, 3>;
  const auto place = [&](const Corner& c) -> Eigen::Vector3d {
    return Eigen::Vector3d(c[0], c[1], c[2]) * (2.0 / cells) - Eigen::Vector3d::Ones();
  };
  std::map<Corner, double> values;
  for (int x = 0; x <= cells; ++x) {
    for (int y = 0; y <= cells; ++y) {
      for (int z = 0; z <= cells; ++z) values[{x, y, z}] = volume(place({x, y, z}));
    }
  }
  Mesh mesh;
  std::map<std::array<Corner, 2>, Index> vertices;
  const auto vertex = [&](Corner a, Corner b) {
    if (b < a) std::swap(a, b);
    const auto [it, is_new] =
        vertices.emplace(std::array{a, b}, static_cast<Index>(mesh.positions.size()));
    if (is_new) {
      const double share = std::clamp(values[a] / (values[a] - values[b]), 0.001, 0.999);
      mesh.positions.push_back(((1 - share) * place(a) + share * place(b)).cast<float>());
    }
    return it->second;
  };
  const auto add_tetrahedron = [&](const std::array<Corner, 4>& t) {
    std::vector<Corner> inside, outside;
    for (const Corner& c : t) (values[c] < 0 ? inside : outside).push_back(c);
    if (inside.empty() || outside.empty()) return;
    std::vector<Index> polygon;
    if (inside.size() == 2) {
      polygon = {vertex(inside[0], outside[0]), vertex(inside[0], outside[1]),
                 vertex(inside[1], outside[1]), vertex(inside[1], outside[0])};
    } else {
      const bool one = inside.size() == 1;
      for (const Corner& c : one ? outside : inside) {
        polygon.push_back(vertex((one ? inside : outside)[0], c));
      }
    }
    const auto at = [&](std::size_t k) -> Vec3 { return mesh.positions[polygon[k]]; };
    const Vec3 out = (place(outside[0]) - place(inside[0])).cast<float>();
    if ((at(1) - at(0)).cross(at(2) - at(0)).dot(out) < 0) std::ranges::reverse(polygon);
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      mesh.faces.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
  };
  // Six in each cell, along the ways from its first corner to its last.
  for (int x = 0; x < cells; ++x) {
    for (int y = 0; y < cells; ++y) {
      for (int z = 0; z < cells; ++z) {
        std::array<std::size_t, 3> axes{0, 1, 2};
        do {
          std::array<Corner, 4> t{Corner{x, y, z}};
          for (std::size_t k = 0; k < 3; ++k) {
            t[k + 1] = t[k];
            ++t[k + 1][axes[k]];
          }
          add_tetrahedron(t);
        } while (std::ranges::next_permutation(axes).found);
      }
    }
  }
  return mesh;
}

}  // namespace meshgrain::made
