#include "meshgrain/statistics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/edges.h"
#include "mesh/marks.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;

/// Mean, spread and range of numbers seen one after the other (Welford 1962).
class Spread {
 public:
  void add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / double(count_);
    squares_ += delta * (x - mean_);
    least_ = count_ == 1 ? x : std::min(least_, x);
    most_ = count_ == 1 ? x : std::max(most_, x);
  }
  double mean() const { return mean_; }
  double sigma() const { return count_ == 0 ? 0 : std::sqrt(squares_ / double(count_)); }
  double least() const { return least_; }
  double most() const { return most_; }

 private:
  std::size_t count_ = 0;
  double mean_ = 0, squares_ = 0, least_ = 0, most_ = 0;
};

double over(double x, double mean) {
  return mean > 0 ? x / mean : 0;
}

/// The corners of one face after another, as points.
class Polygon {
 public:
  void set(const Mesh& mesh, std::span<const Index> face) {
    points_.clear();
    for (Index v : face) points_.push_back(mesh.positions[v].cast<double>());
  }
  std::size_t size() const { return points_.size(); }
  const Point& at(std::size_t k) const { return points_[k % points_.size()]; }

  /// Twice the area vector of the triangle of three corners.
  Point normal(std::size_t a, std::size_t b, std::size_t c) const {
    return (at(b) - at(a)).cross(at(c) - at(a));
  }

  /// Twice the area vector of the whole polygon.
  Point normal() const {
    Point n = Point::Zero();
    for (std::size_t k = 1; k + 1 < size(); ++k) n += normal(0, k, k + 1);
    return n;
  }

  double area() const {
    double sum = 0;
    for (std::size_t k = 1; k + 1 < size(); ++k) sum += normal(0, k, k + 1).norm() / 2;
    if (size() == 4) sum = std::min(sum, (normal(1, 2, 3).norm() + normal(1, 3, 4).norm()) / 2);
    return sum;
  }

 private:
  std::vector<Point> points_;
};

void measure_faces(const Mesh& mesh, MeshStatistics& s) {
  Spread areas, angles, least_angles, most_angles;
  double squares = 0;
  std::size_t corners = 0;
  std::vector<double> jacobians;  // of quads
  Polygon polygon;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    polygon.set(mesh, mesh.faces[f]);
    const std::size_t n = polygon.size();
    ++(n == 3 ? s.triangles : n == 4 ? s.quads : s.larger);
    areas.add(polygon.area());
    const Point up = polygon.normal().stableNormalized();
    const double regular = 180.0 * (double(n) - 2) / double(n);
    double least = 360, most = 0, least_sine = 1;
    for (std::size_t k = 0; k < n; ++k) {
      const Point ahead = (polygon.at(k + 1) - polygon.at(k)).stableNormalized();
      const Point back = (polygon.at(k + n - 1) - polygon.at(k)).stableNormalized();
      const Point turn = ahead.cross(back);
      double angle = std::atan2(turn.norm(), ahead.dot(back)) * 180 / std::numbers::pi;
      if (n > 3 && turn.dot(up) < 0) angle = 360 - angle;  // reflex
      least_sine = std::min(least_sine, turn.dot(up));
      angles.add(angle);
      least = std::min(least, angle);
      most = std::max(most, angle);
      squares += (angle - regular) * (angle - regular);
      ++corners;
    }
    least_angles.add(least);
    most_angles.add(most);
    if (n == 4) jacobians.push_back(least_sine);
  }
  if (!jacobians.empty()) {
    s.inverted_quads = static_cast<std::size_t>(
        std::ranges::count_if(jacobians, [](double sine) { return sine <= 0; }));
    s.jacobian_min = std::ranges::min(jacobians);
    const auto percent = jacobians.begin() + static_cast<std::ptrdiff_t>(jacobians.size() / 100);
    std::ranges::nth_element(jacobians, percent);
    s.jacobian_p01 = *percent;
  }
  s.area_sigma = over(areas.sigma(), areas.mean());
  s.area_min = over(areas.least(), areas.mean());
  s.area_max = over(areas.most(), areas.mean());
  s.angle_sigma = corners == 0 ? 0 : std::sqrt(squares / double(corners));
  s.angle_min = angles.least();
  s.angle_max = angles.most();
  s.angle_min_mean = least_angles.mean();
  s.angle_max_mean = most_angles.mean();
}

void measure_edges(const Mesh& mesh, const std::vector<Edge>& edges, MeshStatistics& s) {
  Spread lengths;
  UnionFind loops(mesh.positions.size());
  std::vector<std::uint8_t> on_border(mesh.positions.size(), 0);
  for (const Edge& edge : edges) {
    lengths.add((mesh.positions[edge.a] - mesh.positions[edge.b]).cast<double>().norm());
    s.non_manifold_edges += edge.uses > 2;
    if (edge.uses != 1) continue;
    // Each border vertex starts a loop, each border edge that joins two of them ends one.
    for (Index v : {edge.a, edge.b}) s.boundary_loops += !std::exchange(on_border[v], 1);
    s.boundary_loops -= loops.unite(edge.a, edge.b);
  }
  s.edge_mean = lengths.mean();
  s.edge_sigma = over(lengths.sigma(), lengths.mean());
}

/// Number of `edges` that are marked.
std::size_t count_marked(const Mesh& mesh, const std::vector<Edge>& edges) {
  const auto marks = sorted_marks(mesh);
  return static_cast<std::size_t>(std::count_if(edges.begin(), edges.end(), [&](const Edge& edge) {
    return std::binary_search(marks.begin(), marks.end(), std::array{edge.a, edge.b});
  }));
}

/// Number of vertices whose faces do not all hang together by shared edges at the vertex.
std::size_t count_non_manifold_vertices(const Mesh& mesh) {
  const Faces& faces = mesh.faces;
  // Every corner as two spokes, sorted by vertex.
  struct Spoke {
    Index neighbour, face;
  };
  std::vector<std::size_t> end(mesh.positions.size() + 1, 0);
  for (Index v : faces.corners()) end[v + 1] += 2;
  for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  std::vector<Spoke> spokes(end.back());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    for (std::size_t c = 0, n = face.size(); c < n; ++c) {
      spokes[end[face[c]]++] = {face[(c + 1) % n], static_cast<Index>(f)};
      spokes[end[face[c]]++] = {face[(c + n - 1) % n], static_cast<Index>(f)};
    }
  }
  std::size_t count = 0, begin = 0;
  std::vector<Index> around;
  for (std::size_t v = 0; v < mesh.positions.size(); begin = end[v++]) {
    const std::span<Spoke> star(spokes.data() + begin, end[v] - begin);
    if (star.size() <= 2) continue;
    around.clear();
    for (const Spoke& spoke : star) around.push_back(spoke.face);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    std::sort(star.begin(), star.end(), [](Spoke a, Spoke b) { return a.neighbour < b.neighbour; });
    UnionFind fans(around.size());
    std::size_t fan_count = around.size();
    const auto local = [&](Index face) {
      return static_cast<Index>(std::lower_bound(around.begin(), around.end(), face) -
                                around.begin());
    };
    for (std::size_t i = 1; i < star.size(); ++i)
      if (star[i].neighbour == star[i - 1].neighbour)
        fan_count -= fans.unite(local(star[i].face), local(star[i - 1].face));
    count += fan_count > 1;
  }
  return count;
}

}  // namespace

MeshStatistics mesh_statistics(const Mesh& mesh) {
  MeshStatistics s;
  s.vertices = mesh.positions.size();
  s.faces = mesh.faces.size();
  measure_faces(mesh, s);

  const std::vector<Edge> edges = edges_of(mesh);
  measure_edges(mesh, edges, s);
  s.marked_edges = count_marked(mesh, edges);
  s.non_manifold_vertices = count_non_manifold_vertices(mesh);

  std::vector<std::uint8_t> used(s.vertices, 0);
  UnionFind pieces(s.vertices);
  std::size_t used_count = 0;
  for (std::size_t f = 0; f < s.faces; ++f)
    for (Index v : mesh.faces[f]) {
      used_count += !std::exchange(used[v], 1);
      s.components -= pieces.unite(v, mesh.faces[f][0]);  // from the number of used vertices down
    }
  s.components += used_count;
  s.isolated_vertices = s.vertices - used_count;
  s.euler = long(used_count) - long(edges.size()) + long(s.faces);

  const VertexDegrees degrees = vertex_degrees(mesh, edges);
  for (std::size_t v = 0; v < s.vertices; ++v) s.irregular_vertices += degrees.irregular(v);
  s.singularities = s.irregular_vertices;
  for (std::size_t f = 0; f < s.faces; ++f) {
    s.singularities += mesh.faces.degree(f) != degrees.regular_face;
  }
  return s;
}

double bounding_diagonal(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  const auto cover = [&](Index v) { box.extend(mesh.positions[v].cast<double>()); };
  if (mesh.is_point_cloud())
    for (Index v = 0; v < mesh.positions.size(); ++v) cover(v);
  else
    for (Index v : mesh.faces.corners()) cover(v);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace meshgrain
