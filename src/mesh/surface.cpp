#include "meshgrain/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "util/hilbert.h"

namespace meshgrain {

double face_area(const Mesh& mesh, std::size_t f) {
  const auto face = mesh.faces[f];
  const Vec3& a = mesh.positions[face[0]];
  double area = 0;
  for (std::size_t k = 2; k < face.size(); ++k) {
    area += 0.5 * (mesh.positions[face[k - 1]] - a).cross(mesh.positions[face[k]] - a).norm();
  }
  return area;
}

double surface_area(const Mesh& mesh) {
  double area = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) area += face_area(mesh, f);
  return area;
}

EdgeLengths edge_lengths(const Mesh& mesh) {
  EdgeLengths result;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Vec3& next = mesh.positions[face[k + 1 == face.size() ? 0 : k + 1]];
      const double length = (next - mesh.positions[face[k]]).norm();
      result.mean += length;
      result.max = std::max(result.max, length);
    }
  }
  if (!mesh.faces.empty()) result.mean /= static_cast<double>(mesh.faces.corners().size());
  return result;
}

namespace {

template <typename T>
void permute(std::vector<T>& values, const std::vector<Index>& order) {
  if (values.empty()) return;
  std::vector<T> result(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) result[k] = values[order[k]];
  values.swap(result);
}

}  // namespace

std::vector<Index> sort_along_curve(Mesh& mesh, const Context& context) {
  const std::vector<Index> order = hilbert_order(mesh.positions, context);
  permute(mesh.positions, order);
  permute(mesh.normals, order);
  permute(mesh.values, order);

  std::vector<Index> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<Index>(k);
  for (Index& v : mesh.faces.corners()) v = rank[v];
  for (auto& edge : mesh.marked_edges) edge = {rank[edge[0]], rank[edge[1]]};

  // Counting sort of the faces by their first vertex along the curve.
  std::vector<Index> start(order.size() + 1, 0);
  const auto first_vertex = [&](std::size_t f) {
    const auto face = mesh.faces[f];
    return *std::min_element(face.begin(), face.end());
  };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) ++start[first_vertex(f) + 1];
  for (std::size_t v = 0; v < order.size(); ++v) start[v + 1] += start[v];
  std::vector<Index> face_order(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    face_order[start[first_vertex(f)]++] = static_cast<Index>(f);
  }
  Faces sorted;
  sorted.reserve(mesh.faces.size(), mesh.faces.corners().size());
  for (const Index f : face_order) sorted.push_back(std::as_const(mesh.faces)[f]);
  mesh.faces = std::move(sorted);
  return order;
}

}  // namespace meshgrain
