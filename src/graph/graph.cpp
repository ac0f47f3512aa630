#include "meshgrain/graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "graph/cloud_normals.h"
#include "graph/nearest_neighbors.h"
#include "graph/vertex_graph.h"
#include "mesh/sort_by_vertex.h"
#include "mesh/vertex_faces.h"
#include "mesh/vertex_measures.h"
#include "mesh/vertex_normals.h"
#include "mesh/vertex_ring.h"
#include "meshgrain/error.h"
#include "util/collect.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 4096;

/// Fills offsets and neighbours from `neighbors_of(i, out)`, which appends the neighbours of node i
/// in increasing order.
template <typename NeighborsOf>
void gather_neighbors(Graph& graph, const NeighborsOf& neighbors_of, const Context& context) {
  const std::size_t n = graph.size();
  graph.offsets.assign(n + 1, 0);
  std::vector<std::vector<Index>> gathered((n + grain - 1) / grain);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    auto& out = gathered[begin / grain];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t start = out.size();
      neighbors_of(static_cast<Index>(i), out);
      graph.offsets[i + 1] = static_cast<Index>(out.size() - start);
    }
  });
  // SIMD lanes count entries with a sign.
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  std::size_t entries = 0;
  for (std::size_t i = 0; i < n; ++i) {
    entries += graph.offsets[i + 1];
    if (entries > most) {
      throw Error("too large: the points have more than 2147483647 neighbours in all");
    }
    graph.offsets[i + 1] = static_cast<Index>(entries);
  }
  graph.neighbors.resize(graph.offsets[n]);
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t) {
    auto& range = gathered[begin / grain];
    std::ranges::copy(range, graph.neighbors.begin() + graph.offsets[begin]);
    range = {};
  });
}

void sort_unique_from(std::vector<Index>& values, std::size_t start) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(start);
  std::sort(begin, values.end());
  values.erase(std::unique(begin, values.end()), values.end());
}

float cotangent(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - apex, v = b - apex;
  const float sine = u.cross(v).norm();
  return sine > 0 ? u.dot(v) / sine : 0.0f;
}

/// Cotangents, from both sides of each edge.
void weigh_edges(Graph& graph, const Mesh& mesh, const VertexFaces& around,
                 const Context& context) {
  graph.weights.assign(graph.neighbors.size(), 0);
  context.for_ranges(graph.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      for (const Index f : around[v]) {
        const auto face = mesh.faces[f];
        const auto k = corner_of(face, v);
        const Index b = face[(k + 1) % 3], c = face[(k + 2) % 3];
        const Vec3 &p = mesh.positions[v], &q = mesh.positions[b], &r = mesh.positions[c];
        graph.weights[graph.entry(v, b)] += 0.5f * cotangent(r, p, q);
        graph.weights[graph.entry(v, c)] += 0.5f * cotangent(q, p, r);
      }
      // Weights must be positive for the local steps to lower the energy; obtuse pairs count little
      // instead of less than nothing, needles do not outweigh everything else.
      for (std::size_t e = graph.offsets[v]; e < graph.offsets[v + 1]; ++e) {
        graph.weights[e] = std::clamp(graph.weights[e], 0.01f, 10.0f);
      }
    }
  });
}

void require_triangles(const Mesh& mesh) {
  if (mesh.faces.uniform_degree() != 3) {
    throw Error("a graph is built from triangles: triangulate the mesh first");
  }
}

Graph face_graph(const Mesh& mesh, const Context& context) {
  Graph graph;
  const std::size_t n = mesh.faces.size();
  graph.positions.resize(n);
  graph.normals.resize(n);
  graph.areas.resize(n);
  for (std::size_t f = 0; f < n; ++f) {
    const auto face = mesh.faces[f];
    const Vec3 &a = mesh.positions[face[0]], &b = mesh.positions[face[1]],
               &c = mesh.positions[face[2]];
    graph.positions[f] = (a + b + c) / 3;
    const Vec3 normal = (b - a).cross(c - a);
    const float twice_area = normal.norm();
    graph.areas[f] = 0.5f * twice_area;
    graph.normals[f] = twice_area > 0 ? Vec3(normal / twice_area) : Vec3::UnitZ();
  }
  const VertexFaces around = vertex_faces(mesh, context);
  gather_neighbors(
      graph,
      [&](Index f, std::vector<Index>& out) {
        const std::size_t start = out.size();
        const auto face = mesh.faces[f];
        for (std::size_t k = 0; k < 3; ++k) {
          const auto first = around[face[k]], second = around[face[(k + 1) % 3]];
          std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
                                std::back_inserter(out));
        }
        sort_unique_from(out, start);
        out.erase(std::find(out.begin() + static_cast<std::ptrdiff_t>(start), out.end(), f));
      },
      context);
  return graph;
}

Graph cloud_graph(const Mesh& cloud, const GraphOptions& options, const Context& context) {
  if (cloud.positions.size() < 4) throw Error("a point cloud needs at least four points");
  Graph graph;
  graph.positions = cloud.positions;
  graph.normals = cloud_normals(cloud, options.neighbors, context);
  const std::size_t n = cloud.positions.size();
  const Neighborhoods nearest = nearest_neighbors(cloud.positions, options.neighbors, context);

  // Being among the nearest is not mutual, but the fields need every edge from both ends.
  struct Edge {
    Index from, to;
  };
  const auto find_one_sided = [&](std::size_t begin, std::size_t end, std::vector<Edge>& out) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      for (const Index j : nearest[i]) {
        if (std::ranges::find(nearest[j], i) == nearest[j].end()) out.push_back({j, i});
      }
    }
  };
  const std::vector<Edge> one_sided = collect<Edge>(n, find_one_sided, context);
  UninitializedVector<Index> others(one_sided.size());
  const std::vector<Index> offsets = sort_by_vertex(
      one_sided.size(), n, [&](std::size_t e) { return std::array{one_sided[e].from}; },
      [&](std::size_t e, Index place) { others[place] = one_sided[e].to; }, context);
  gather_neighbors(
      graph,
      [&](Index i, std::vector<Index>& out) {
        const auto start = static_cast<std::ptrdiff_t>(out.size());
        out.insert(out.end(), nearest[i].begin(), nearest[i].end());
        out.insert(out.end(), others.begin() + offsets[i], others.begin() + offsets[i + 1]);
        std::sort(out.begin() + start, out.end());
      },
      context);

  // Of evenly scattered points, as many as there are a unit of area, the j-th nearest lies at a
  // mean squared distance of j / (pi density): the k nearest together tell the area of one.
  graph.areas.resize(n);
  std::vector<float> scale(n, 0);  // mean squared distance to the neighbours
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto neighbors = nearest[i];
      float squares = 0;
      for (const Index j : neighbors) {
        squares += (graph.positions[j] - graph.positions[i]).squaredNorm();
      }
      const float count = static_cast<float>(neighbors.size());
      const float mean = count > 0 ? squares / count : 0.0f;
      graph.areas[i] = 3.14159265f * 2 * mean / (count + 1);
      scale[i] = mean;
    }
  });
  if (options.weights == GraphWeights::uniform) return graph;
  graph.weights.resize(graph.neighbors.size());
  context.for_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
        // The heat kernel of Belkin et al. 2009, at the mean of both ends' scales: weights must be
        // the same from either end, or there is no energy that the local steps lower.
        const Index j = graph.neighbors[e];
        const float d = (graph.positions[j] - graph.positions[i]).squaredNorm();
        const float both = scale[i] + scale[j];
        graph.weights[e] = both > 0 ? std::max(std::exp(-d / both), 0.01f) : 1.0f;
      }
    }
  });
  return graph;
}

}  // namespace

Graph vertex_graph(const Mesh& mesh, const VertexFaces& around, const GraphOptions& options,
                   const Context& context) {
  Graph graph;
  graph.positions = mesh.positions;
  VertexMeasures measures = measure_vertices(mesh, around, context);
  graph.areas = std::move(measures.areas);
  graph.normals = options.crease_degrees < 0
                      ? std::move(measures.normals)
                      : vertex_normals(mesh, around, options.crease_degrees, context);
  gather_neighbors(
      graph,
      [&](Index v, std::vector<Index>& out) {
        VertexRing ring;
        if (ring.find(mesh, around[v], v)) {
          out.insert(out.end(), ring.neighbors().begin(), ring.neighbors().end());
          return;
        }
        const std::size_t start = out.size();
        for (const Index f : around[v]) {
          for (const Index w : mesh.faces[f]) {
            if (w != v) out.push_back(w);
          }
        }
        sort_unique_from(out, start);
      },
      context);
  if (options.weights == GraphWeights::geometric) weigh_edges(graph, mesh, around, context);
  return graph;
}

Graph build_graph(const Mesh& mesh, const GraphOptions& options, const Context& context) {
  if (mesh.is_point_cloud()) return cloud_graph(mesh, options, context);
  require_triangles(mesh);
  return options.nodes == GraphNodes::faces
             ? face_graph(mesh, context)
             : vertex_graph(mesh, vertex_faces(mesh, context), options, context);
}

}  // namespace meshgrain
