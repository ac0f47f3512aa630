#include "field/transfer.h"

#include <span>

#include "field/posy.h"
#include "field/rosy.h"
#include "field/with_symmetry.h"
#include "graph/nearest_neighbors.h"
#include "meshgrain/error.h"

namespace meshgrain {
namespace {

/// The vertices of the fields' surface.
std::vector<Vec3> points_of(const Fields& fields, const Frame& frame) {
  std::vector<Vec3> points;
  points.reserve(fields.surface.positions.size());
  for (const Vec3& p : fields.surface.positions) {
    points.push_back(frame.inside(p.cast<double>() + fields.surface.origin).cast<float>());
  }
  if (points.empty()) throw Error("the given fields have no values");
  return points;
}

/// For each node, the nearest vertex of the fields' surface.
std::vector<Index> nearest_vertices(const Fields& fields, const Graph& graph, const Frame& frame,
                                    const Context& context) {
  return nearest_points(points_of(fields, frame), graph.positions, context);
}

OrientationField orientation_of(const Fields& fields, const Graph& graph,
                                std::span<const Index> nearest) {
  OrientationField result{fields.orientation.rosy, std::vector<Vec3>(graph.size())};
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const Vec3 d = project_to_plane(fields.orientation.directions[nearest[i]], graph.normals[i]);
    result.directions[i] = d.norm() > 1e-6f ? Vec3(d.normalized()) : any_tangent(graph.normals[i]);
  }
  return result;
}

}  // namespace

OrientationField transfer_orientation(const Fields& fields, const Graph& graph, const Frame& frame,
                                      const Context& context) {
  return orientation_of(fields, graph, nearest_vertices(fields, graph, frame, context));
}

PositionField transfer_position(const Fields& fields, const Graph& graph, const Frame& frame,
                                const Context& context) {
  const auto nearest = nearest_vertices(fields, graph, frame, context);
  const OrientationField orientation = orientation_of(fields, graph, nearest);
  const PositionField& from = fields.position;
  PositionField result;
  result.posy = from.posy;
  result.points.resize(graph.size());
  std::vector<float> lengths;
  const std::size_t count = from.edge_length.uniform() ? 1 : graph.size();
  for (std::size_t i = 0; i < count; ++i) {
    lengths.push_back(static_cast<float>(from.edge_length[nearest[i]] / frame.scale));
  }
  result.edge_length = EdgeLength(std::move(lengths));
  with_posy(from.posy, [&]<int S>() {
    for (std::size_t i = 0; i < graph.size(); ++i) {
      const Vec3 p = frame.inside(from.points[nearest[i]].cast<double>() + fields.surface.origin)
                         .cast<float>();
      const Vec3& n = graph.normals[i];
      const PoSy<S> lattice(p - n * n.dot(p - graph.positions[i]), orientation.directions[i], n,
                            result.edge_length[i]);
      result.points[i] = lattice.point(lattice.round(graph.positions[i]));
    }
  });
  return result;
}

bool is_of_another_surface(const Fields& fields, const Graph& graph, const Frame& frame,
                           const Context& context) {
  constexpr double far = 0.01;  // of the unit
  const std::vector<Vec3> points = points_of(fields, frame);
  const auto nearest = nearest_points(points, graph.positions, context);
  double distance = 0;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    distance += (graph.positions[i] - points[nearest[i]]).norm();
  }
  distance /= static_cast<double>(graph.size());
  if (distance <= far) return false;
  const Neighborhoods neighbors = nearest_neighbors(points, 1, context);
  double spacing = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Index j : neighbors[i]) spacing += (points[i] - points[j]).norm();
  }
  return distance > spacing / static_cast<double>(points.size());
}

}  // namespace meshgrain
