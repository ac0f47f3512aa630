#include "field/transfer.h"

#include <utility>

#include "cloud/nearest_neighbors.h"
#include "field/posy.h"
#include "field/rosy.h"
#include "field/with_symmetry.h"
#include "meshgrain/error.h"

namespace meshgrain {

FieldTransfer::FieldTransfer(const Fields& fields, const Graph& graph, const Frame& frame,
                             const Context& context)
    : fields_(fields), graph_(graph), frame_(frame) {
  points_.reserve(fields.surface.positions.size());
  for (const Vec3& p : fields.surface.positions) {
    points_.push_back(frame.inside(p.cast<double>() + fields.surface.origin).cast<float>());
  }
  if (points_.empty()) throw Error("the given fields have no values");
  nearest_ = nearest_points(points_, graph.positions, context);
}

OrientationField FieldTransfer::orientation() const {
  OrientationField result{fields_.orientation.rosy, std::vector<Vec3>(graph_.size())};
  for (std::size_t i = 0; i < graph_.size(); ++i) {
    const Vec3 &n = graph_.normals[i], &given = fields_.orientation.directions[nearest_[i]];
    const Vec3 d = project_to_plane(given, n);
    result.directions[i] = d.norm() > 1e-6f ? Vec3(d.normalized()) : any_tangent(n);
  }
  return result;
}

PositionField FieldTransfer::position() const {
  const std::vector<Vec3> directions = orientation().directions;
  const PositionField& from = fields_.position;
  PositionField result;
  result.posy = from.posy;
  result.points.resize(graph_.size());
  std::vector<float> lengths;
  const std::size_t count = from.edge_length.uniform() ? 1 : graph_.size();
  for (std::size_t i = 0; i < count; ++i) {
    lengths.push_back(static_cast<float>(from.edge_length[nearest_[i]] / frame_.scale));
  }
  result.edge_length = EdgeLength(std::move(lengths));
  with_posy(from.posy, [&]<int S>() {
    for (std::size_t i = 0; i < graph_.size(); ++i) {
      const Eigen::Vector3d given = from.points[nearest_[i]].cast<double>();
      const Vec3 p = frame_.inside(given + fields_.surface.origin).cast<float>();
      const Vec3& n = graph_.normals[i];
      const PoSy<S> lattice(p - n * n.dot(p - graph_.positions[i]), directions[i], n,
                            result.edge_length[i]);
      result.points[i] = lattice.point(lattice.round(graph_.positions[i]));
    }
  });
  return result;
}

bool FieldTransfer::is_of_another_surface(const Context& context) const {
  constexpr double far = 0.01;  // of the unit
  double distance = 0;
  for (std::size_t i = 0; i < graph_.size(); ++i) {
    distance += (graph_.positions[i] - points_[nearest_[i]]).norm();
  }
  distance /= static_cast<double>(graph_.size());
  if (distance <= far) return false;
  const Neighborhoods neighbors = nearest_neighbors(points_, 1, context);
  double spacing = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (const Index j : neighbors[i]) spacing += (points_[i] - points_[j]).norm();
  }
  return distance > spacing / static_cast<double>(points_.size());
}

}  // namespace meshgrain
