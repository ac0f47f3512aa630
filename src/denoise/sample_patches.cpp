#include "denoise/sample_patches.h"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/vertex_faces.h"

namespace meshgrain {

Mesh sample_patches(const Mesh& mesh, std::size_t count, std::size_t size, const Context& context) {
  if (mesh.faces.size() <= count * size) return mesh;
  const VertexFaces around = vertex_faces(mesh, context);
  std::vector<std::uint8_t> taken(mesh.faces.size(), 0);
  Mesh result;
  for (std::size_t patch = 0; patch < count; ++patch) {
    const std::size_t seed = (2 * patch + 1) * mesh.faces.size() / (2 * count);
    if (taken[seed]) continue;
    std::vector<Index> faces{static_cast<Index>(seed)};
    taken[seed] = 1;
    for (std::size_t k = 0; k < faces.size() && faces.size() < size; ++k) {
      for (const Index v : mesh.faces[faces[k]]) {
        for (const Index f : around[v]) {
          if (!std::exchange(taken[f], std::uint8_t{1})) faces.push_back(f);
        }
      }
    }
    std::unordered_map<Index, Index> number;
    for (const Index f : faces) {
      std::vector<Index> corners;
      for (const Index v : mesh.faces[f]) {
        const auto [at, is_new] = number.emplace(v, static_cast<Index>(result.positions.size()));
        if (is_new) result.positions.push_back(mesh.positions[v]);
        corners.push_back(at->second);
      }
      result.faces.push_back(corners);
    }
  }
  return result;
}

}  // namespace meshgrain
