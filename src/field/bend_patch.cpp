#include "field/bend_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace meshgrain {
namespace {

/// The angle between the normals of the triangles left and right of an edge, positive where they
/// lean apart; all vectors begin where the edge does.
float dihedral_angle(const Vec3& edge, float length, const Vec3& left, const Vec3& right) {
  // The triangles' normals are edge x left and right x edge; only their lengths cancel out.
  const float sine = length * edge.cross(right).dot(left);
  const float cosine = edge.dot(left) * edge.dot(right) - length * length * left.dot(right);
  // Most angles are small, where the series has the same digits as the function, which is slow.
  const float x = sine / cosine;
  if (cosine > 0 && std::fabs(x) < 0.15f) return x * (1 - x * x * (1.0f / 3 - x * x / 5));
  return std::atan2(sine, cosine);
}

}  // namespace

void BendPatch::add(float bend, const Vec3& u) {
  const std::array<float, 6> products{u.x() * u.x(), u.y() * u.y(), u.z() * u.z(),
                                      u.x() * u.y(), u.x() * u.z(), u.y() * u.z()};
  for (std::size_t k = 0; k < 6; ++k) form[k] += bend * products[k];
  turn += std::fabs(bend);
}

void BendPatch::add(const BendPatch& other) {
  for (std::size_t k = 0; k < 6; ++k) form[k] += other.form[k];
  area += other.area;
  turn += other.turn;
}

float BendPatch::product(const Vec3& u, const Vec3& v) const {
  const auto& [xx, yy, zz, xy, xz, yz] = form;
  return u.x() * (xx * v.x() + xy * v.y() + xz * v.z()) +
         u.y() * (xy * v.x() + yy * v.y() + yz * v.z()) +
         u.z() * (xz * v.x() + yz * v.y() + zz * v.z());
}

float BendPatch::norm() const {
  float sum = 0;
  for (std::size_t k = 0; k < 6; ++k) sum += (k < 3 ? 1.0f : 2.0f) * form[k] * form[k];
  return area > 0 ? std::sqrt(sum) / area : 0.0f;
}

BendPatches::BendPatches(const Hierarchy& hierarchy, const Mesh& surface, const VertexFaces& around,
                         const FeatureLines& creases, const Context& context)
    : hierarchy_(hierarchy),
      surface_(surface),
      around_(around),
      creases_(creases, surface.positions.size()) {
  if (are_vertices(hierarchy, surface)) return;
  const Graph& finest = hierarchy.levels[0];
  curvature_ = estimate_curvature(finest.offsets, finest.neighbors, finest.positions,
                                  finest.normals, context);
}

BendPatch BendPatches::of(std::size_t level, Index node) const {
  BendPatch patch;
  if (level > 0) {
    for (const Index child : hierarchy_.children[level - 1][node]) patch.add(of(level - 1, child));
    return patch;
  }
  const float area = hierarchy_.levels[0].areas[node];
  if (!curvature_) {
    patch = of_vertex(node);
  } else {
    const Vec3& along = curvature_->direction[node];
    patch.add(area * curvature_->kmax[node], hierarchy_.levels[0].normals[node].cross(along));
    patch.add(area * curvature_->kmin[node], along);
  }
  patch.area = area;
  return patch;
}

/// Half of each edge goes to either end.
BendPatch BendPatches::of_vertex(Index a) const {
  const auto faces = around_[a];
  // The other corners of each face, in its sense; most vertices have few faces.
  using Corners = std::array<Index, 2>;
  std::array<Corners, 12> few;
  std::vector<Corners> many(faces.size() > few.size() ? faces.size() : 0);
  const std::span<Corners> corners =
      many.empty() ? std::span(few).first(faces.size()) : std::span(many);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const auto face = surface_.faces[faces[k]];
    corners[k] = face[0] == a   ? Corners{face[1], face[2]}
                 : face[1] == a ? Corners{face[2], face[0]}
                                : Corners{face[0], face[1]};
  }
  // Rings of many faces are searched by halving.
  const auto second = [](const Corners& c) { return c[1]; };
  std::ranges::sort(many, {}, second);
  const auto across = [&](Index b) {
    const auto it = many.empty() ? std::ranges::find(corners, b, second)
                                 : std::ranges::lower_bound(corners, b, {}, second);
    return it != corners.end() && second(*it) == b ? (*it)[0] : no_index;
  };
  BendPatch patch;
  const Vec3& from = surface_.positions[a];
  for (const auto& [b, left] : corners) {
    const Index right = across(b);
    if (right == no_index || creases_.line(a, b) != no_index) continue;
    const Vec3 edge = surface_.positions[b] - from;
    const float length = edge.norm();
    if (!(length > 0)) continue;
    const float angle = dihedral_angle(edge, length, surface_.positions[left] - from,
                                       surface_.positions[right] - from);
    patch.add(0.5f * angle * length, edge / length);
  }
  return patch;
}

BendPatch with_neighbors(const Graph& graph, const std::vector<BendPatch>& patches, Index node) {
  BendPatch sum = patches[node];
  for (const Index j : graph.neighbors_of(node)) sum.add(patches[j]);
  return sum;
}

bool are_vertices(const Hierarchy& hierarchy, const Mesh& surface) {
  return !surface.is_point_cloud() && surface.positions.size() == hierarchy.levels[0].size();
}

std::size_t level_of_area(const Hierarchy& hierarchy, double area) {
  const std::vector<float>& areas = hierarchy.levels[0].areas;
  const double whole = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::size_t level = 0;
  while (level + 1 < hierarchy.levels.size() &&
         whole / static_cast<double>(hierarchy.levels[level].size()) < area) {
    ++level;
  }
  return level;
}

}  // namespace meshgrain
