#include "field/bending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "features/feature_edges.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/curvature.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 2048;

/// A second fundamental form as a symmetric matrix of space, integrated over a patch, and the
/// patch's area. In space, forms of different tangent planes can be added.
struct Patch {
  std::array<float, 6> form{};  // xx, yy, zz, xy, xz, yz
  float area = 0;

  void add(float amount, const Vec3& u) {
    const std::array<float, 6> products{u.x() * u.x(), u.y() * u.y(), u.z() * u.z(),
                                        u.x() * u.y(), u.x() * u.z(), u.y() * u.z()};
    for (std::size_t k = 0; k < 6; ++k) form[k] += amount * products[k];
  }
  void add(const Patch& other) {
    for (std::size_t k = 0; k < 6; ++k) form[k] += other.form[k];
    area += other.area;
  }
  float norm() const {
    float sum = 0;
    for (std::size_t k = 0; k < 6; ++k) sum += (k < 3 ? 1.0f : 2.0f) * form[k] * form[k];
    return area > 0 ? std::sqrt(sum) / area : 0.0f;
  }
};

Vec3 normal_of(const Mesh& triangles, Index f) {
  const auto face = triangles.faces[f];
  const Vec3& a = triangles.positions[face[0]];
  return (triangles.positions[face[1]] - a)
      .cross(triangles.positions[face[2]] - a)
      .normalized();  // or zero
}

/// The corner after `v` in a triangle, or the one before it.
Index after(std::span<const Index> face, Index v) {
  return face[0] == v ? face[1] : face[1] == v ? face[2] : face[0];
}
Index before(std::span<const Index> face, Index v) {
  return face[0] == v ? face[2] : face[1] == v ? face[0] : face[1];
}

/// Half of each edge goes to either end.
std::vector<Patch> patches_of_vertices(const Mesh& triangles, const FeatureLines& creases,
                                       const Context& context) {
  const VertexFaces around = vertex_faces(triangles, context);
  const FeatureEdges lines(creases, triangles.positions.size());
  std::vector<Patch> patches(triangles.positions.size());
  context.for_ranges(patches.size(), grain, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (auto a = static_cast<Index>(begin); a < end; ++a) {
      for (const Index f : around[a]) {
        const Index b = after(triangles.faces[f], a);
        const auto faces = around[a];
        const auto other = std::find_if(faces.begin(), faces.end(), [&](Index g) {
          return before(triangles.faces[g], a) == b;
        });
        if (other == faces.end() || lines.line(a, b) != no_index) continue;
        const Vec3 edge = triangles.positions[b] - triangles.positions[a];
        const float length = edge.norm();
        if (!(length > 0)) continue;
        const Vec3 left = normal_of(triangles, f), right = normal_of(triangles, *other);
        const Vec3 along = edge / length;
        const float angle = std::atan2(right.cross(left).dot(along), right.dot(left));
        patches[a].add(0.5f * angle * length, along);
      }
    }
  });
  return patches;
}

std::vector<Patch> patches_of_nodes(const Graph& graph, const Context& context) {
  const Curvature curvature =
      estimate_curvature(graph.offsets, graph.neighbors, graph.positions, graph.normals, context);
  std::vector<Patch> patches(graph.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Vec3& along = curvature.direction[i];
    patches[i].add(graph.areas[i] * curvature.kmax[i], along);
    patches[i].add(graph.areas[i] * curvature.kmin[i], graph.normals[i].cross(along));
  }
  return patches;
}

/// Means of each node and its neighbours.
void even_out(const Graph& graph, std::vector<float>& values, const Context& context) {
  std::vector<float> next(values.size());
  context.for_ranges(values.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float sum = values[i];
      for (const Index j : graph.neighbors_of(i)) sum += values[j];
      next[i] = sum / static_cast<float>(1 + graph.neighbors_of(i).size());
    }
  });
  values.swap(next);
}

}  // namespace

std::vector<float> bending(const Hierarchy& hierarchy, const Mesh& surface,
                           const FeatureLines& creases, double area, const Context& context) {
  const Graph& finest = hierarchy.levels[0];
  const bool on_vertices = !surface.is_point_cloud() && surface.positions.size() == finest.size();
  std::vector<Patch> patches = on_vertices ? patches_of_vertices(surface, creases, context)
                                           : patches_of_nodes(finest, context);
  for (std::size_t i = 0; i < patches.size(); ++i) patches[i].area = finest.areas[i];

  // Up to the level whose nodes are as large as the patches.
  const double whole = std::accumulate(finest.areas.begin(), finest.areas.end(), 0.0);
  std::size_t level = 0;
  while (level + 1 < hierarchy.levels.size() &&
         whole / static_cast<double>(hierarchy.levels[level].size()) < area) {
    std::vector<Patch> larger(hierarchy.levels[level + 1].size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
      larger[hierarchy.parents[level][i]].add(patches[i]);
    }
    patches.swap(larger);
    ++level;
  }
  const Graph& graph = hierarchy.levels[level];
  std::vector<float> result(patches.size());
  context.for_ranges(patches.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Patch sum = patches[i];
      for (const Index j : graph.neighbors_of(i)) sum.add(patches[j]);
      result[i] = sum.norm();
    }
  });

  // And down again, evened out on each level.
  for (; level > 0; --level) {
    const std::vector<Index>& parents = hierarchy.parents[level - 1];
    std::vector<float> finer(parents.size());
    for (std::size_t i = 0; i < finer.size(); ++i) finer[i] = result[parents[i]];
    result.swap(finer);
    even_out(hierarchy.levels[level - 1], result, context);
  }
  return result;
}

}  // namespace meshgrain
