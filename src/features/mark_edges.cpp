#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "cloud/nearest_neighbors.h"
#include "mesh/edges.h"
#include "mesh/frame.h"
#include "meshgrain/error.h"
#include "meshgrain/features.h"
#include "meshgrain/statistics.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

/// Where each point of a line is in the mesh.
class Places {
 public:
  Places(const Mesh& mesh, const Frame& frame, const std::vector<Edge>& edges)
      : frame_(frame), tolerance_(1e-4 * bounding_diagonal(mesh) / frame.scale) {
    std::vector<std::uint8_t> used(mesh.positions.size(), 0);
    for (const Edge& edge : edges) used[edge.a] = used[edge.b] = 1;
    for (Index v = 0; v < mesh.positions.size(); ++v) {
      if (!used[v]) continue;
      vertices_.push_back(v);
      positions_.push_back((mesh.positions[v].cast<double>() / frame.scale).cast<float>());
    }
  }

  /// The vertex of the mesh for each vertex of the lines.
  std::vector<Index> of(const Polylines& lines, const Context& context) const {
    if (vertices_.empty())
      throw Error("edges can only be marked of a mesh: the input has no faces");
    std::vector<Vec3> queries;
    for (const Index p : lines.vertices) {
      queries.push_back(frame_.inside(lines.points[p]).cast<float>());
    }
    std::vector<Index> result = nearest_points(positions_, queries, context);
    for (std::size_t k = 0; k < result.size(); ++k) {
      const double distance = (positions_[result[k]] - queries[k]).norm();
      if (!(distance <= tolerance_)) fail(lines, lines.vertices[k], distance);
      result[k] = vertices_[result[k]];
    }
    return result;
  }

 private:
  [[noreturn]] void fail(const Polylines& lines, Index point, double distance) const {
    const Eigen::Vector3d& p = lines.points[point];
    throw Error(
        fmt::format("vertex {}, at ({:g}, {:g}, {:g}), lies at no vertex of the mesh: the nearest "
                    "is {:.3g} away",
                    point + 1, p.x(), p.y(), p.z(), distance * frame_.scale));
  }

  const Frame& frame_;
  double tolerance_;
  std::vector<Index> vertices_;  // those of faces
  std::vector<Vec3> positions_;  // in the frame
};

/// Ways along the edges of a mesh.
class Ways {
 public:
  Ways(const Mesh& mesh, const Frame& frame, const std::vector<Edge>& edges)
      : mesh_(mesh), scale_(frame.scale), offsets_(mesh.positions.size() + 1, 0) {
    for (const Edge& edge : edges) ++offsets_[edge.a + 1], ++offsets_[edge.b + 1];
    for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
    neighbors_.resize(offsets_.back());
    std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
    for (const Edge& edge : edges) {
      neighbors_[next[edge.a]++] = edge.b;
      neighbors_[next[edge.b]++] = edge.a;
    }
    cost_.assign(mesh.positions.size(), unknown);
    from_.assign(mesh.positions.size(), no_index);
  }

  /// Appends the edges of the shortest way from one vertex to another; false if there is none.
  bool append(Index start, Index end, std::vector<std::array<Index, 2>>& out) {
    if (are_neighbors(start, end)) {
      out.push_back({start, end});
      return true;
    }
    search(start, end);
    const bool found = cost_[end] != unknown;
    for (Index v = end; found && v != start; v = from_[v]) out.push_back({from_[v], v});
    for (const Index v : touched_) cost_[v] = unknown;
    touched_.clear();
    return found;
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  Eigen::Vector3d position(Index v) const { return mesh_.positions[v].cast<double>() / scale_; }

  bool are_neighbors(Index a, Index b) const {
    const auto end = neighbors_.begin() + offsets_[a + 1];
    return std::find(neighbors_.begin() + offsets_[a], end, b) != end;
  }

  /// A*: the distance that is left is at least that through space.
  void search(Index start, Index end) {
    const Eigen::Vector3d p = position(start), q = position(end);
    const double length = (q - p).norm();
    // In a grid many ways are equally short.
    constexpr double straightness = 1e-3;
    const auto cost = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      const double aside = (to - closest_point_on_segment<Eigen::Vector3d>(to, p, q)).norm();
      return (to - from).norm() * (1 + straightness * (length > 0 ? aside / length : 0));
    };
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    const auto reach = [&](Index v, double way, Index from) {
      if (way >= cost_[v]) return;
      if (cost_[v] == unknown) touched_.push_back(v);
      cost_[v] = way;
      from_[v] = from;
      queue.push({way + (q - position(v)).norm(), way, v});
    };
    reach(start, 0, no_index);
    while (!queue.empty()) {
      const auto [bound, way, v] = queue.top();
      if (v == end) return;
      queue.pop();
      if (way > cost_[v]) continue;
      for (Index k = offsets_[v]; k < offsets_[v + 1]; ++k) {
        const Index next = neighbors_[k];
        reach(next, way + cost(position(v), position(next)), v);
      }
    }
  }

  struct Candidate {
    double bound, way;
    Index vertex;
    auto operator<=>(const Candidate&) const = default;
  };

  const Mesh& mesh_;
  double scale_;
  std::vector<Index> offsets_, neighbors_;
  std::vector<double> cost_;  // of the way to each vertex that was touched
  std::vector<Index> from_;   // the vertex before it
  std::vector<Index> touched_;
};

}  // namespace

void mark_edges(Mesh& mesh, const Polylines& lines, const Context& context) {
  const Frame frame = unit_frame(mesh);
  const std::vector<Edge> edges = edges_of(mesh);
  const std::vector<Index> vertices = Places(mesh, frame, edges).of(lines, context);
  Ways ways(mesh, frame, edges);
  std::vector<std::array<Index, 2>> found;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (Index k = lines.begin(line); k + 1 < lines.end(line); ++k) {
      context.check();
      const Index a = vertices[k], b = vertices[k + 1];
      if (a == b || ways.append(a, b, found)) continue;
      throw Error(fmt::format("no edges of the mesh lead from vertex {} to vertex {}",
                              lines.vertices[k] + 1, lines.vertices[k + 1] + 1));
    }
  }
  mesh.marked_edges.insert(mesh.marked_edges.end(), found.begin(), found.end());
}

}  // namespace meshgrain
