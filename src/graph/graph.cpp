#include "meshgrain/graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "cloud/cloud_graph.h"
#include "cloud/nearest_neighbors.h"
#include "graph/gather_neighbors.h"
#include "graph/vertex_graph.h"
#include "mesh/vertex_faces.h"
#include "mesh/vertex_measures.h"
#include "mesh/vertex_normals.h"
#include "mesh/vertex_ring.h"
#include "meshgrain/error.h"

namespace meshgrain {
namespace {

constexpr std::size_t grain = 4096;

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
  if (mesh.is_point_cloud()) {
    Neighborhoods nearest = nearest_neighbors(mesh.positions, options.neighbors, context);
    if (!mesh.normals.empty()) leave_out_other_sides(nearest, mesh.normals, context);
    return cloud_graph(mesh, nearest, options, context);
  }
  require_triangles(mesh);
  return options.nodes == GraphNodes::faces
             ? face_graph(mesh, context)
             : vertex_graph(mesh, vertex_faces(mesh, context), options, context);
}

}  // namespace meshgrain
