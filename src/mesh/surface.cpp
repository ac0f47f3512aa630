#include "meshgrain/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <utility>

#include "mesh/vertex_faces.h"
#include "util/hilbert.h"
#include "util/sum.h"

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

double surface_area(const Mesh& mesh, const Context& context) {
  return sum_over_ranges(
      mesh.faces.size(),
      [&](std::size_t begin, std::size_t end) {
        double area = 0;
        for (std::size_t f = begin; f < end; ++f) area += face_area(mesh, f);
        return area;
      },
      context);
}

EdgeLengths edge_lengths(const Mesh& mesh, const Context& context) {
  struct Lengths {
    double sum = 0, max = 0;
    Lengths operator+(const Lengths& o) const { return {sum + o.sum, std::max(max, o.max)}; }
  };
  const auto lengths = sum_over_ranges(
      mesh.faces.size(),
      [&](std::size_t begin, std::size_t end) {
        Lengths result;
        for (std::size_t f = begin; f < end; ++f) {
          const auto face = mesh.faces[f];
          if (face.empty()) continue;
          Index last = face.back();
          for (const Index v : face) {
            const double length = (mesh.positions[v] - mesh.positions[last]).norm();
            result = result + Lengths{length, length};
            last = v;
          }
        }
        return result;
      },
      context);
  const auto sides = static_cast<double>(std::max<std::size_t>(1, mesh.faces.corners().size()));
  return {lengths.sum / sides, lengths.max};
}

namespace {

constexpr std::size_t grain = 8192;

template <typename T>
void permute(std::vector<T>& values, const std::vector<Index>& order, const Context& context) {
  if (values.empty()) return;
  std::vector<T> result(values.size());
  context.for_ranges(order.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) result[k] = values[order[k]];
  });
  values.swap(result);
}

/// Sorts faces by their first vertex, those with the same one in the order that they had.
void sort_faces(Faces& faces, std::size_t vertices, const Context& context) {
  const std::vector<Index> order = faces_by_lowest_vertex(faces, vertices, context).faces;
  Faces sorted;
  if (const std::size_t degree = faces.uniform_degree(); degree > 0) {
    sorted = Faces::uniform(faces.size(), degree);
    context.for_ranges(faces.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        std::ranges::copy(std::as_const(faces)[order[k]], sorted[k].begin());
      }
    });
  } else {
    sorted.reserve(faces.size(), faces.corners().size());
    for (const Index f : order) sorted.push_back(std::as_const(faces)[f]);
  }
  faces = std::move(sorted);
}

}  // namespace

std::vector<Index> sort_along_curve(Mesh& mesh, const Context& context) {
  const std::vector<Index> order = hilbert_order(mesh.positions, context);
  permute(mesh.positions, order, context);
  permute(mesh.normals, order, context);
  permute(mesh.values, order, context);

  std::vector<Index> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<Index>(k);
  const std::span<Index> corners = mesh.faces.corners();
  context.for_ranges(corners.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) corners[c] = rank[corners[c]];
  });
  for (auto& edge : mesh.marked_edges) edge = {rank[edge[0]], rank[edge[1]]};
  sort_faces(mesh.faces, order.size(), context);
  return order;
}

}  // namespace meshgrain
