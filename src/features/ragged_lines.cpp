#include "features/ragged_lines.h"

#include <algorithm>
#include <array>
#include <span>

#include "meshgrain/normals.h"
#include "util/edge_of.h"

namespace meshgrain {
namespace {

/// A line by the way along it.
class Course {
 public:
  Course(std::span<const Vec3> points, bool closed) : points_(points), closed_(closed) {
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Eigen::Vector3d a = points[k - 1].cast<double>(), b = points[k].cast<double>();
      const double length = (b - a).norm();
      ways_.push_back(ways_.back() + length);
      sums_.push_back(sums_.back() + length / 2 * (a + b));
    }
  }

  /// The mean over the way from `reach` before a point to as much after it.
  Vec3 mean(std::size_t point, double reach) const {
    const double at = ways_[point];
    const double width = std::min(reach, closed_ ? length() / 4 : std::min(at, length() - at));
    if (!(width > 0)) return points_[point];
    return ((sum(at + width) - sum(at - width)) / (2 * width)).cast<float>();
  }

 private:
  double length() const { return ways_.back(); }

  /// The integral of the line from its beginning.
  Eigen::Vector3d sum(double way) const {
    if (way < 0) return sum(way + length()) - sums_.back();
    if (way > length()) return sums_.back() + sum(way - length());
    const auto next = std::upper_bound(ways_.begin() + 1, ways_.end() - 1, way);
    const std::size_t k = static_cast<std::size_t>(next - ways_.begin()) - 1;
    const Eigen::Vector3d a = points_[k].cast<double>(), b = points_[k + 1].cast<double>();
    const double length = ways_[k + 1] - ways_[k], part = way - ways_[k];
    const Eigen::Vector3d middle =
        length > 0 ? Eigen::Vector3d(a + part / (2 * length) * (b - a)) : a;
    return sums_[k] + part * middle;
  }

  std::span<const Vec3> points_;
  bool closed_;
  std::vector<double> ways_{0};  // to each point
  std::vector<Eigen::Vector3d> sums_{Eigen::Vector3d::Zero()};
};

/// Whether a line turns sharply between its ends, and again within `reach`.
bool is_ragged(const FeatureLines& lines, std::size_t line, double reach) {
  const auto& p = lines.positions;
  double way = 2 * reach;  // since the last turn
  for (Index k = lines.begin(line) + 1; k + 1 < lines.end(line); ++k) {
    way += (p[k] - p[k - 1]).norm();
    if (!is_sharp_turn(p[k] - p[k - 1], p[k + 1] - p[k])) continue;
    if (way < reach) return true;
    way = 0;
  }
  return false;
}

}  // namespace

void even_out_ragged_lines(FeatureLines& lines, const Mesh& mesh,
                           const std::vector<EdgeOfLine>& edges, double reach,
                           const Context& context) {
  std::vector<std::array<Index, 2>> drawn;
  for (const EdgeOfLine& edge : edges) {
    if (edge.kind == LineKind::drawn) drawn.push_back(edge.ends);
  }
  std::ranges::sort(drawn);
  const auto is_drawn = [&](std::size_t line) {
    for (Index k = lines.begin(line) + 1; k < lines.end(line); ++k) {
      const auto ends = edge_of(lines.vertices[k - 1], lines.vertices[k]);
      if (!std::ranges::binary_search(drawn, ends)) return false;
    }
    return true;
  };
  std::vector<Vec3> normals;
  for (std::size_t line = 0; line < lines.size() && !drawn.empty(); ++line) {
    if (!is_drawn(line) || !is_ragged(lines, line, reach)) continue;
    if (normals.empty()) normals = vertex_normals(mesh, -1, context);
    const Index begin = lines.begin(line), end = lines.end(line);
    const std::vector<Vec3> before(lines.positions.begin() + begin, lines.positions.begin() + end);
    const bool closed = lines.is_closed(line);
    const Course course(before, closed);
    for (Index k = begin; k < end; ++k) {
      const Vec3& normal = normals[lines.vertices[k]];
      const Vec3 move = course.mean(k - begin, reach) - before[k - begin];
      lines.positions[k] += move - normal.dot(move) * normal;
    }
  }
}

}  // namespace meshgrain
