#include "meshgrain/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <utility>

#include "mesh/sort_by_vertex.h"
#include "mesh/surface_size.h"
#include "util/hilbert.h"
#include "util/sum.h"

namespace meshgrain {

namespace {

template <typename Face>
double fan_area(const std::vector<Vec3>& positions, const Face& face) {
  const Vec3& a = positions[face[0]];
  double area = 0;
  for (std::size_t k = 2; k < face.size(); ++k) {
    area += 0.5 * (positions[face[k - 1]] - a).cross(positions[face[k]] - a).norm();
  }
  return area;
}

}  // namespace

double face_area(const Mesh& mesh, std::size_t f) {
  return fan_area(mesh.positions, mesh.faces[f]);
}

SurfaceSize surface_size(const Mesh& mesh, const Context& context) {
  struct Sums {
    double area = 0, length = 0, longest = 0;
    Sums operator+(const Sums& o) const {
      return {area + o.area, length + o.length, std::max(longest, o.longest)};
    }
  };
  const Sums sums = with_corners(mesh.faces, [&](const auto& corners) {
    const auto measure = [&](std::size_t begin, std::size_t end) {
      Sums here;
      for (std::size_t f = begin; f < end; ++f) {
        const auto face = corners(f);
        if (face.empty()) continue;
        Index last = face.back();
        for (const Index v : face) {
          const double length = (mesh.positions[v] - mesh.positions[last]).norm();
          here.length += length;
          here.longest = std::max(here.longest, length);
          last = v;
        }
        here.area += fan_area(mesh.positions, face);
      }
      return here;
    };
    return sum_over_ranges(mesh.faces.size(), measure, context);
  });
  const auto sides = static_cast<double>(std::max<std::size_t>(1, mesh.faces.corners().size()));
  return {sums.area, {sums.length / sides, sums.longest}};
}

double surface_area(const Mesh& mesh, const Context& context) {
  return surface_size(mesh, context).area;
}

EdgeLengths edge_lengths(const Mesh& mesh, const Context& context) {
  return surface_size(mesh, context).edges;
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
  Faces sorted;
  if (const std::size_t degree = faces.uniform_degree(); degree > 0) {
    sorted = Faces::uniform(faces.size(), degree);
    Index* const to = sorted.corners().data();
    with_corners(faces, [&](const auto& corners) {
      const auto put = [&](std::size_t f, std::size_t place) {
        std::ranges::copy(corners(f), to + degree * place);
      };
      return sort_by_lowest_vertex(faces, vertices, put, context);
    });
  } else {
    sorted.reserve(faces.size(), faces.corners().size());
    std::vector<Index> order(faces.size());
    const auto put = [&](std::size_t f, std::size_t place) {
      order[place] = static_cast<Index>(f);
    };
    sort_by_lowest_vertex(faces, vertices, put, context);
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
  context.for_ranges(order.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) rank[order[k]] = static_cast<Index>(k);
  });
  const std::span<Index> corners = mesh.faces.corners();
  context.for_ranges(corners.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) corners[c] = rank[corners[c]];
  });
  for (auto& edge : mesh.marked_edges) edge = {rank[edge[0]], rank[edge[1]]};
  sort_faces(mesh.faces, order.size(), context);
  return order;
}

}  // namespace meshgrain
