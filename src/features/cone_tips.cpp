#include "features/cone_tips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_set>
#include <utility>

#include "measure/face_shape.h"
#include "mesh/vertex_faces.h"
#include "util/angle.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

/// Whether all edges of a vertex are as steep as those of a cone, to one side of its tangent plane.
bool is_steep(const Graph& graph, Index v) {
  constexpr float steep = 0.5f;  // the cosine to the normal; 0.55 at the tip of such a cone
  bool any_up = false, any_down = false;
  for (const Index w : graph.neighbors_of(v)) {
    const Vec3 edge = graph.positions[w] - graph.positions[v];
    const float height = graph.normals[v].dot(edge);
    if (!(std::abs(height) > steep * edge.norm())) return false;
    (height > 0 ? any_up : any_down) = true;
  }
  return any_up != any_down;
}

class Tips {
 public:
  Tips(const Mesh& mesh, const Graph& graph, const FeatureLines& lines, double reach,
       const Context& context)
      : mesh_(mesh),
        graph_(graph),
        around_(vertex_faces(mesh, context)),
        on_line_(graph.size(), 0),
        reach_(static_cast<float>(reach)) {
    for (const Index v : lines.vertices) on_line_[v] = 1;
  }

  bool is_tip(Index v) const {
    constexpr double least = std::numbers::pi / 3, elsewhere = 0.25;
    const double own = missing_angle(v);
    if (!(own >= least) || !is_round(v)) return false;
    double others = 0;
    std::vector<Index> found{v};
    std::unordered_set<Index> is_found{v};
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (on_line_[found[k]]) return false;
      if (k > 0) others += std::abs(missing_angle(found[k]));
      if (others > elsewhere * own) return false;
      for (const Index w : graph_.neighbors_of(found[k])) {
        const bool is_near = (graph_.positions[w] - graph_.positions[v]).norm() < reach_;
        if (is_near && is_found.insert(w).second) found.push_back(w);
      }
    }
    return true;
  }

 private:
  /// Whether no two faces around a vertex that meet at an edge do so sharply, as those of a
  /// pyramid.
  bool is_round(Index v) const {
    constexpr float cos40 = 0.766f;
    std::vector<std::array<Index, 2>> sides;  // the other end of an edge, and a face beside it
    for (const Index f : around_[v]) {
      for (const Index w : std::as_const(mesh_.faces)[f]) {
        if (w != v) sides.push_back({w, f});
      }
    }
    std::ranges::sort(sides);
    for (std::size_t k = 1; k < sides.size(); ++k) {
      if (sides[k][0] != sides[k - 1][0]) continue;
      const Vec3 a = area(sides[k - 1][1]), b = area(sides[k][1]);
      if (a.dot(b) < cos40 * a.norm() * b.norm()) return false;
    }
    return true;
  }

  Vec3 area(Index f) const { return area_vector(std::as_const(mesh_.faces)[f], mesh_.positions); }

  /// What the angles around a vertex are short of a turn.
  double missing_angle(Index v) const {
    double sum = 0;
    for (const Index f : around_[v]) {
      const auto face = std::as_const(mesh_.faces)[f];
      const std::size_t k = corner_of(face, v);
      const Vec3 &p = mesh_.positions[v], &q = mesh_.positions[face[(k + 1) % 3]],
                 &r = mesh_.positions[face[(k + 2) % 3]];
      const Vec3 a = q - p, b = r - p;
      sum += quick_angle(a.cross(b).norm(), a.dot(b));
    }
    return 2 * std::numbers::pi - sum;
  }

  const Mesh& mesh_;
  const Graph& graph_;
  VertexFaces around_;
  std::vector<std::uint8_t> on_line_;
  float reach_;
};

}  // namespace

std::vector<Index> find_cone_tips(const Mesh& mesh, const Graph& graph, const FeatureLines& lines,
                                  double edge_length, const Context& context) {
  std::vector<Index> steep = indices_where(
      graph.size(), [&](Index v) { return is_steep(graph, v); }, context);
  if (steep.empty()) return steep;
  const Tips tips(mesh, graph, lines, edge_length, context);
  std::erase_if(steep, [&](Index v) { return !tips.is_tip(v); });
  return steep;
}

}  // namespace meshgrain
