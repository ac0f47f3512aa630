#include "extract/mean_vertex.h"

namespace meshgrain {

Index append_mean(Extraction& extraction, std::span<const Index> vertices) {
  Mesh& mesh = extraction.mesh;
  Vec3 sum = Vec3::Zero(), normal = Vec3::Zero();
  for (const Index v : vertices) {
    sum += mesh.positions[v];
    if (!mesh.normals.empty()) normal += mesh.normals[v];
  }
  const Index seed = extraction.nodes[vertices[0]];
  const auto id = static_cast<Index>(mesh.positions.size());
  mesh.positions.push_back(sum / static_cast<float>(vertices.size()));
  if (!mesh.normals.empty()) {
    const float length = normal.norm();
    mesh.normals.push_back(length > 0 ? Vec3(normal / length) : mesh.normals[vertices[0]]);
  }
  extraction.nodes.push_back(seed);
  return id;
}

}  // namespace meshgrain
