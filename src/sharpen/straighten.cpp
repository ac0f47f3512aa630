#include "sharpen/straighten.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/border.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/surface.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

/// The parabola in the length along a line that fits its points within `reach` of one best, at that
/// point. Points beyond the ends of the line are not there; near an end the fit is a straight one.
Vec3 fitted(const std::vector<Vec3>& points, const std::vector<double>& ways, std::size_t at,
            bool closed, double reach) {
  const std::size_t count = closed ? points.size() - 1 : points.size();
  const double length = ways.back();
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
  const auto add = [&](std::size_t k, double way) {
    const double x = way / reach;
    const double weight = (1 - x * x) * (1 - x * x);
    const Eigen::Vector3d powers(1, x, x * x);
    matrix += weight * powers * powers.transpose();
    right += weight * powers * points[k].cast<double>().transpose();
  };
  int sides[2] = {0, 0};
  add(at, 0);
  for (const bool ahead : {false, true}) {
    std::size_t k = at;
    for (std::size_t steps = 1; steps < count; ++steps) {
      if (!closed && k == (ahead ? count - 1 : 0)) break;
      k = ahead ? (k + 1) % count : (k + count - 1) % count;
      double way = ways[k] - ways[at];
      if (closed && (way > 0) != ahead) way += ahead ? length : -length;
      if (std::abs(way) >= reach) break;
      add(k, way);
      ++sides[ahead];
    }
  }
  if (sides[0] + sides[1] < 3) return points[at];
  // The pull of no curvature where few points tell any.
  matrix(2, 2) += 1e-2 * (std::min(sides[0], sides[1]) < 2 ? 100 : 1);
  return matrix.ldlt().solve(right).row(0).transpose().cast<float>();
}

class Mover {
 public:
  Mover(Mesh& mesh, const Context& context)
      : mesh_(mesh), around_(vertex_faces(mesh, context)), stays_(mesh.positions.size(), 0) {
    for (const auto& ends : rim_edges(mesh, context)) {
      for (const Index v : ends) stays_[v] = 1;
    }
  }

  /// Goes as far towards `to` as no face turns much.
  void move(Index v, const Vec3& to) {
    if (stays_[v]) return;
    const Vec3 from = mesh_.positions[v];
    for (float share = 1; share > 0.1f; share /= 2) {
      const Vec3 p = from + share * (to - from);
      if (!keeps_faces(v, p)) continue;
      mesh_.positions[v] = p;
      return;
    }
  }

  /// The point nearest to the planes of the faces around v that do not touch it.
  Vec3 where_planes_meet(Index v) const {
    std::vector<Index> faces(around_[v].begin(), around_[v].end());
    constexpr int rings = 2;
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<Index> wider;
      for (const Index f : faces) {
        for (const Index w : std::as_const(mesh_.faces)[f]) {
          wider.insert(wider.end(), around_[w].begin(), around_[w].end());
        }
      }
      sort_unique(wider);
      faces.swap(wider);
    }
    const Vec3& p = mesh_.positions[v];
    Eigen::Matrix3f matrix = Eigen::Matrix3f::Zero();
    Vec3 right = Vec3::Zero();
    float total = 0;
    for (const Index f : faces) {
      if (std::ranges::binary_search(around_[v], f)) continue;
      const auto face = std::as_const(mesh_.faces)[f];
      const Vec3 n = normal(face, no_index, p);
      const float area = n.norm();
      if (!(area > 0)) continue;
      const Vec3 d = mesh_.positions[face[0]] - p;
      matrix += n * n.transpose() / area;
      right += n * n.dot(d) / area;
      total += area;
    }
    // Along directions in which the planes say nothing it stays.
    constexpr float stay = 0.03f;
    matrix.diagonal().array() += stay * total;
    return p + Vec3(matrix.ldlt().solve(right));
  }

 private:
  Vec3 normal(std::span<const Index> face, Index v, const Vec3& p) const {
    std::array<Vec3, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = face[k] == v ? p : mesh_.positions[face[k]];
    return (q[1] - q[0]).cross(q[2] - q[0]);
  }
  bool keeps_faces(Index v, const Vec3& p) const {
    return std::all_of(around_[v].begin(), around_[v].end(), [&](Index f) {
      const auto face = std::as_const(mesh_.faces)[f];
      const Vec3 before = normal(face, v, mesh_.positions[v]), after = normal(face, v, p);
      constexpr float cos45 = 0.7f;
      return before.dot(after) > cos45 * before.norm() * after.norm();
    });
  }

  Mesh& mesh_;
  VertexFaces around_;
  std::vector<std::uint8_t> stays_;
};

}  // namespace

void straighten_lines(Mesh& mesh, const FeatureLines& lines, Corners corners,
                      const Context& context) {
  const double reach = 4 * edge_lengths(mesh).mean;
  Mover mover(mesh, context);
  if (corners == Corners::move) {
    for (const Index v : lines.corners) mover.move(v, mover.where_planes_meet(v));
  }
  for (std::size_t line = 0; line < lines.size(); ++line) {
    const std::span<const Index> vertices(lines.vertices.data() + lines.begin(line),
                                          lines.end(line) - lines.begin(line));
    const bool closed = lines.is_closed(line);
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
      std::vector<Vec3> points;
      std::vector<double> ways{0};
      for (const Index v : vertices) points.push_back(mesh.positions[v]);
      for (std::size_t k = 1; k < points.size(); ++k) {
        ways.push_back(ways.back() + (points[k] - points[k - 1]).norm());
      }
      for (std::size_t k = closed ? 0 : 1; k + 1 < points.size(); ++k) {
        mover.move(vertices[k], fitted(points, ways, k, closed, reach));
      }
    }
  }
}

}  // namespace meshgrain
