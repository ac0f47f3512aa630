#include "features/cut_guides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "mesh/splitting.h"
#include "util/edge_of.h"
#include "util/triangle.h"

namespace meshgrain {
namespace {

using Point = Eigen::Vector3d;
using Edge = std::array<Index, 2>;

/// How near a crossing is to a vertex, along the edge, to become that vertex; and how near an end
/// may be to a line. Smaller shares would leave needles.
constexpr double near_vertex = 0.1, near_line = 0.3;

class Cutting {
 public:
  Cutting(Mesh& mesh, const Context& context) : mesh_(mesh, context) {}

  void cut(const GuideRun& run);
  GuideLines result() &&;

 private:
  /// Where a guide leaves the faces around a vertex.
  struct Exit {
    Index a = no_index, b = no_index;  // the edge through which
    double share = 0;                  // from a to b
    double way = 0;                    // along the run: so many points, and a part
  };

  Index insert(const GuideRun::Point& point);
  Index split_edge(Index a, Index b, double share);
  bool leaves(Index v, const Point& p, Exit* exit) const;
  bool find_exit(Index v, const GuideRun& run, double from, Exit& exit) const;
  bool adjacent(Index a, Index b) const;
  void visit(Index v, const GuideRun& run, double way, bool is_end);
  void follow(Index from, Index to, const GuideRun& run);

  Splitting mesh_;
  std::set<Edge> edges_;
  struct Visit {
    Vec3 position, direction;
    bool twice;
  };
  std::map<Index, Visit> visits_;
};

Index Cutting::split_edge(Index a, Index b, double share) {
  const Index m = mesh_.split_edge(a, b, share);
  if (edges_.erase(edge_of(a, b)) != 0) {
    edges_.insert(edge_of(a, m));
    edges_.insert(edge_of(m, b));
  }
  return m;
}

/// The barycentric coordinates of a point of a triangle.
std::array<double, 3> coordinates(const Point& p, const std::array<Point, 3>& t) {
  const Point ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const Point n = ab.cross(ac);
  const double square = n.squaredNorm();
  if (!(square > 0)) return {1, 0, 0};
  const double v = ap.cross(ac).dot(n) / square, w = ab.cross(ap).dot(n) / square;
  return {1 - v - w, v, w};
}

/// A vertex at a point of the surface: one that is there, or a new one.
Index Cutting::insert(const GuideRun::Point& point) {
  double least = std::numeric_limits<double>::infinity();
  Index face = no_index;
  std::array<double, 3> weights{};
  for (const Index f : mesh_.parts(point.face)) {
    const auto c = mesh_.face(f);
    const std::array<Point, 3> t{mesh_.position(c[0]), mesh_.position(c[1]), mesh_.position(c[2])};
    const Point q = closest_point_on_triangle(point.position, t[0], t[1], t[2]);
    const double distance = (q - point.position).norm();
    if (distance >= least) continue;
    least = distance;
    face = f;
    weights = coordinates(q, t);
  }
  const std::array<Index, 3> c{mesh_.face(face)[0], mesh_.face(face)[1], mesh_.face(face)[2]};
  // A weight is the distance from the side opposite, as a share of the height.
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_line = visits_.count(c[k]) != 0;
    if (weights[k] > 1 - (is_line ? near_line : near_vertex)) return c[k];
  }
  std::size_t side = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_line = edges_.count(edge_of(c[(k + 1) % 3], c[(k + 2) % 3])) != 0;
    const double reach = is_line ? near_line : near_vertex;
    if (weights[k] < reach && (side == 3 || weights[k] < weights[side])) side = k;
  }
  if (side == 3) return mesh_.split_face(face, weights);
  const Index a = c[(side + 1) % 3], b = c[(side + 2) % 3];
  const double share = weights[(side + 2) % 3] / (1 - weights[side]);
  if (share < near_vertex) return a;
  if (share > 1 - near_vertex) return b;
  return split_edge(a, b, share);
}

/// Whether a point lies outside of the faces around a vertex, or on their rim; if so, where there
/// it is nearest.
bool Cutting::leaves(Index v, const Point& p, Exit* exit) const {
  double least = std::numeric_limits<double>::infinity();
  bool outside = false;
  for (const Index f : mesh_.around(v)) {
    const auto c = mesh_.face(f);
    const std::array<Point, 3> t{mesh_.position(c[0]), mesh_.position(c[1]), mesh_.position(c[2])};
    const Point q = closest_point_on_triangle(p, t[0], t[1], t[2]);
    const double distance = (q - p).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    const auto k = static_cast<std::size_t>(std::find(c.begin(), c.end(), v) - c.begin());
    const auto weights = coordinates(q, t);
    outside = weights[k] < 1e-6;
    if (outside && exit != nullptr) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      const double both = weights[a] + weights[b];
      exit->a = c[a];
      exit->b = c[b];
      exit->share = both > 0 ? weights[b] / both : 0.5;
    }
  }
  return outside;
}

bool Cutting::find_exit(Index v, const GuideRun& run, double from, Exit& exit) const {
  const auto at = [&](double way) -> Point {
    const auto k = std::min(static_cast<std::size_t>(way), run.points.size() - 2);
    const double share = way - static_cast<double>(k);
    return (1 - share) * run.points[k].position + share * run.points[k + 1].position;
  };
  const auto last = static_cast<double>(run.points.size() - 1);
  double inside = from;
  for (double way = std::floor(from) + 1; way <= last; ++way) {
    if (!leaves(v, at(way), nullptr)) {
      inside = way;
      continue;
    }
    double outside = way;
    constexpr int halvings = 20;
    for (int k = 0; k < halvings; ++k) {
      const double middle = (inside + outside) / 2;
      (leaves(v, at(middle), nullptr) ? outside : inside) = middle;
    }
    leaves(v, at(outside), &exit);
    exit.way = outside;
    return true;
  }
  return false;
}

bool Cutting::adjacent(Index a, Index b) const {
  for (const Index f : mesh_.around(a)) {
    const auto c = mesh_.face(f);
    if (std::find(c.begin(), c.end(), b) != c.end()) return true;
  }
  return false;
}

void Cutting::visit(Index v, const GuideRun& run, double way, bool is_end) {
  const auto k = std::min(static_cast<std::size_t>(way), run.points.size() - 2);
  const double share = way - static_cast<double>(k);
  const auto &a = run.points[k], &b = run.points[k + 1];
  const Point p = (1 - share) * a.position + share * b.position;
  const Point direction = (share < 0.5 ? a : b).direction;
  const auto [it, is_new] =
      visits_.try_emplace(v, Visit{p.cast<float>(), direction.cast<float>(), false});
  if (!is_new && !(is_end && run.closed)) it->second.twice = true;
}

void Cutting::follow(Index from, Index to, const GuideRun& run) {
  struct Step {
    Index vertex;
    double way;
    bool is_new_edge;  // from the step before
  };
  std::vector<Step> path{{from, 0, false}};
  const auto step_to = [&](Index v, double way) {
    const bool is_new = edges_.insert(edge_of(path.back().vertex, v)).second;
    path.push_back({v, way, is_new});
  };
  const auto last = static_cast<double>(run.points.size() - 1);
  const std::size_t most = 50 * run.points.size() + 1000;
  for (std::size_t steps = 0; steps < most; ++steps) {
    const Index v = path.back().vertex;
    Exit exit;
    if (!find_exit(v, run, path.back().way, exit)) break;
    // At the very end the last vertex lies ahead, whatever the rounding.
    if (exit.way > last - 1e-3 && adjacent(v, to)) break;
    Index next = no_index;
    if (exit.share < near_vertex) next = exit.a;
    if (exit.share > 1 - near_vertex) next = exit.b;
    if (next == no_index) next = split_edge(exit.a, exit.b, exit.share);
    if (path.size() > 1 && path[path.size() - 2].vertex == next) {  // there and back
      if (path.back().is_new_edge) edges_.erase(edge_of(path.back().vertex, next));
      path.pop_back();
      path.back().way = exit.way;
    } else {
      step_to(next, exit.way);
    }
  }
  if (path.back().vertex != to && adjacent(path.back().vertex, to)) step_to(to, last);
  for (std::size_t k = 0; k < path.size(); ++k) {
    visit(path[k].vertex, run, path[k].way, k > 0 && path[k].vertex == to);
  }
}

void Cutting::cut(const GuideRun& run) {
  const Index from = insert(run.points.front());
  const Index to = run.closed ? from : insert(run.points.back());
  if (!run.closed && from == to) return visit(from, run, 0, true);  // it may cut another guide
  GuideRun ending = run;
  ending.points.front().position = mesh_.position(from);
  ending.points.back().position = mesh_.position(to);
  follow(from, to, ending);
}

GuideLines Cutting::result() && {
  GuideLines lines;
  for (const Edge& ends : edges_) lines.edges.push_back({ends, LineKind::guide});
  for (const auto& [v, visit] : visits_) {
    lines.vertices.push_back(
        {v, visit.position, visit.twice ? Vec3(Vec3::Zero()) : visit.direction});
  }
  return lines;
}

}  // namespace

GuideLines cut_guides(Mesh& surface, std::span<const GuideRun> runs, const Context& context) {
  Cutting cutting(surface, context);
  for (const GuideRun& run : runs) cutting.cut(run);
  return std::move(cutting).result();
}

void renumber(GuideLines& lines, std::span<const Index> order) {
  std::vector<Index> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<Index>(k);
  for (EdgeOfLine& edge : lines.edges) {
    edge.ends = edge_of(rank[edge.ends[0]], rank[edge.ends[1]]);
  }
  for (GuideLines::Vertex& v : lines.vertices) v.vertex = rank[v.vertex];
  std::sort(lines.edges.begin(), lines.edges.end(),
            [](const EdgeOfLine& a, const EdgeOfLine& b) { return a.ends < b.ends; });
  std::sort(lines.vertices.begin(), lines.vertices.end(),
            [](const auto& a, const auto& b) { return a.vertex < b.vertex; });
}

}  // namespace meshgrain
