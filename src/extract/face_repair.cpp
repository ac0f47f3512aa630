#include "extract/face_repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/tangent_angle.h"

namespace meshgrain {

using std::numbers::pi;

FaceRepair::FaceRepair(PolygonMap& map, Clusters& clusters, int posy,
                       std::vector<std::uint8_t> holes, std::vector<Index> lines)
    : map_(map),
      clusters_(clusters),
      posy_(posy),
      hole_(std::move(holes)),
      lines_(std::move(lines)) {}

/// As PolygonMap::add_edge(), for an edge inside of a face.
Index FaceRepair::add_edge(Index a, Index b) {
  const Index added = map_.add_edge(a, b);
  hole_.resize(map_.halfedges(), 0);
  lines_.resize(map_.halfedges() / 2, no_index);
  return added;
}

/// The angle at v from one neighbour counterclockwise to another, in the tangent plane: 0 to 2 pi.
double FaceRepair::angle(Index v, Index from, Index to) const {
  const auto& p = clusters_.positions;
  return tangent_angle(p[v], p[from], p[to], clusters_.normals[v]);
}

/// The inner angle of h's face at the origin of h.
double FaceRepair::corner_angle(Index h) const {
  return angle(map_.origin(h), map_.target(h), map_.origin(map_.prev(h)));
}

bool FaceRepair::same_orbit(Index a, Index b) const {
  Index h = a;
  do {
    if (h == b) return true;
    h = map_.next(h);
  } while (h != a);
  return false;
}

/// The sum of the normals of the triangles of a fan, twice as long as the area.
Vec3 FaceRepair::face_normal(Index h) const {
  const Vec3& first = clusters_.positions[map_.origin(h)];
  Vec3 sum = Vec3::Zero();
  for (Index g = map_.next(h); map_.next(g) != h; g = map_.next(g)) {
    sum += (clusters_.positions[map_.origin(g)] - first)
               .cross(clusters_.positions[map_.target(g)] - first);
  }
  return sum;
}

/// What lies across a hole is.
bool FaceRepair::is_turned_over(Index vertex, const Vec3& normal) const {
  return normal.dot(clusters_.normals[vertex]) < -0.5f * normal.norm();
}

bool FaceRepair::is_straight(Index to, Index from, const Vec3& normal) const {
  return is_straight(map_.origin(to), map_.target(to), map_.origin(from), normal);
}

bool FaceRepair::is_straight(Index v, Index ahead, Index back, const Vec3& normal) const {
  if (clusters_.hold[v] != at_corner) return true;
  const Vec3 a = clusters_.positions[ahead] - clusters_.positions[v];
  const Vec3 b = clusters_.positions[back] - clusters_.positions[v];
  constexpr float straight = -0.6f;
  return is_turned_over(v, normal) != (normal.dot(a.cross(b)) < 0) ||
         a.dot(b) < straight * a.norm() * b.norm();
}

bool FaceRepair::is_last_rung(Index h) const {
  const Index t = PolygonMap::twin(h), to = map_.next(t), from = map_.prev(h);
  return is_between_lines(to, from) && is_straight(to, from, face_normal(h) + face_normal(t));
}

void FaceRepair::part_straight_angles() {
  constexpr int rounds = 8;
  bool again = true;
  for (int round = 0; again && round < rounds; ++round) {
    again = false;
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (map_.removed(h) || hole_[h]) continue;
      if (!is_between_lines(h, map_.prev(h))) continue;  // as nearly everywhere
      if (!is_straight(h, map_.prev(h), face_normal(h)) || is_alone(h)) continue;
      if ((map_.degree(h) != 3 || make_room(h)) && part_face(h)) continue;
      // Not among triangles: nothing would part what is left into such again.
      if (posy_ == 4 && join_across_hole(h)) {
        again = true;  // other corners of that face have straight angles now
        if (part_face(h)) continue;
      }
      const Index across = map_.next(h);
      add_hub(h);
      // Among quads, the neighbours of the origin of h keep as many edges as they had.
      if (posy_ == 4 && may_remove(across)) map_.remove_edge(across);
    }
  }
}

/// Whether a face is all of its piece. That is smaller than a face, and its border has no corners.
bool FaceRepair::is_alone(Index h) const {
  for (Index g = map_.next(h); g != h; g = map_.next(g)) {
    if (!hole_[PolygonMap::twin(g)]) return false;
  }
  return hole_[PolygonMap::twin(h)] != 0;
}

/// Several faces in a row may lie across a hole, in the way of all edges that the border's vertices
/// there should have to the surface: makes one of them, and of the first face beyond. Returns
/// whether there were several.
bool FaceRepair::join_across_hole(Index h) {
  const auto lies_across = [&](Index g) { return is_turned_over(map_.origin(g), face_normal(g)); };
  const Index beyond = PolygonMap::twin(map_.next(h));
  if (hole_[beyond] || !lies_across(h) || !lies_across(beyond)) return false;
  bool joined = false;
  while (lies_across(h) && join_beyond(h)) joined = true;
  return joined;
}

/// Joins a face with one beside it, even if vertices of the border have no edge but that then.
bool FaceRepair::join_beyond(Index h) {
  constexpr std::size_t most_corners = 8;
  const auto may_lose_one = [&](Index v) { return !is_loose(v) || map_.valence(v) > 3; };
  for (Index g = map_.next(h); g != h; g = map_.next(g)) {
    const Index t = PolygonMap::twin(g);
    if (line(g) != no_index || hole_[t] || touches_itself(g)) continue;
    if (map_.degree(g) + map_.degree(t) > most_corners + 2) continue;
    if (!may_lose_one(map_.origin(g)) || !may_lose_one(map_.target(g))) continue;
    map_.remove_edge(g);
    return true;
  }
  return false;
}

bool FaceRepair::may_remove(Index h) const {
  const Index t = PolygonMap::twin(h);
  return !hole_[h] && !hole_[t] && line(h) == no_index && !is_last_rung(h) && !is_last_rung(t) &&
         map_.valence(map_.origin(h)) > 3 && map_.valence(map_.target(h)) > 3 && !touches_itself(h);
}

/// Joins a triangle with the face opposite to the origin of h, if the edge between them may go.
bool FaceRepair::make_room(Index h) {
  const Index across = map_.next(h), beyond = PolygonMap::twin(across);
  bool has_goal = false;
  for (Index g = map_.next(map_.next(beyond)); g != beyond; g = map_.next(g)) {
    has_goal = has_goal || !map_.adjacent(map_.origin(h), map_.origin(g));
  }
  if (!has_goal || !may_remove(across)) return false;
  map_.remove_edge(across);
  return true;
}

/// Cuts a face in two from the origin of h, to where the two are best, if there is such a place.
bool FaceRepair::part_face(Index h) {
  std::vector<Index> orbit, corners;
  map_.orbit(h, orbit);
  double least = std::numeric_limits<double>::infinity();
  Index best = no_index;
  const std::size_t n = orbit.size();
  for (std::size_t k = 2; k + 1 < n; ++k) {
    if (map_.adjacent(map_.origin(h), map_.origin(orbit[k]))) continue;
    corners.clear();
    for (std::size_t c = 0; c <= k; ++c) corners.push_back(map_.origin(orbit[c]));
    double cost = polygon_cost(corners);
    corners.assign(1, map_.origin(h));
    for (std::size_t c = k; c < n; ++c) corners.push_back(map_.origin(orbit[c]));
    cost += polygon_cost(corners);
    if (cost >= least) continue;
    least = cost;
    best = orbit[k];
  }
  if (best == no_index) return false;
  add_edge(h, best);
  return true;
}

void FaceRepair::remove_dangling() {
  std::vector<Index> label;
  std::vector<Index> orbit;
  for (bool again = true; again;) {
    again = false;
    label.assign(map_.halfedges(), no_index);
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (map_.removed(h) || label[h] != no_index) continue;
      map_.orbit(h, orbit);
      for (const Index g : orbit) label[g] = h;
    }
    for (Index h = 0; h < map_.halfedges(); h += 2) {
      // A removal splits an orbit, and labels of what is left may be too old: look again.
      if (map_.removed(h) || label[h] != label[h + 1] || !same_orbit(h, h + 1)) continue;
      map_.remove_edge(h);
      again = true;
    }
  }
}

void FaceRepair::cut(Index a, Index b) {
  const Index old = map_.origin(a);
  map_.split_vertex(a, b);
  clusters_.positions.push_back(Vec3(clusters_.positions[old]));
  clusters_.normals.push_back(Vec3(clusters_.normals[old]));
  clusters_.nodes.push_back(Index{clusters_.nodes[old]});
  clusters_.on_border.push_back(std::uint8_t{clusters_.on_border[old]});
  clusters_.hold.push_back(std::uint8_t{clusters_.hold[old]});
}

void FaceRepair::cut_pinches() {
  std::vector<Index> orbit;
  std::vector<Index> corner_of(clusters_.positions.size(), no_index);  // in the current orbit
  std::vector<std::uint8_t> done(map_.halfedges(), 0);                 // once for all of an orbit
  for (Index h = 0; h < map_.halfedges(); ++h) {
    if (done[h] != 0) continue;
    for (bool again = true; again && !map_.removed(h);) {
      map_.orbit(h, orbit);
      Index first = no_index, second = no_index;
      for (const Index g : orbit) {
        Index& corner = corner_of[map_.origin(g)];
        if (corner != no_index) {
          first = corner;
          second = g;
          break;
        }
        corner = g;
      }
      for (const Index g : orbit) corner_of[map_.origin(g)] = no_index;
      again = first != no_index;
      if (again) cut(first, second);
      if (!again) {
        for (const Index g : orbit) done[g] = 1;
      }
      corner_of.resize(clusters_.positions.size(), no_index);
    }
    if (!map_.removed(h) && map_.degree(h) == 2) map_.remove_edge(h);
  }
}

void FaceRepair::find_holes(std::span<const std::uint8_t> border_edges,
                            std::span<const std::uint8_t> border_vertices,
                            std::size_t largest_gap) {
  std::vector<std::uint8_t> seen(map_.halfedges(), 0);
  std::vector<Index> orbit;
  for (Index h = 0; h < map_.halfedges(); ++h) {
    if (map_.removed(h) || seen[h]) continue;
    map_.orbit(h, orbit);
    std::size_t edges = 0, vertices = 0;
    double turning = 0;
    for (const Index g : orbit) {
      seen[g] = 1;
      edges += border_edges[g / 2];
      vertices += border_vertices[map_.origin(g)];
      turning += pi - corner_angle(g);
    }
    // Around a face one turns once to the left; around the outside of an open sheet, to the right.
    const bool outside = turning < 0;
    const std::size_t n = orbit.size();
    // Where the lattice runs askew to the border, the gap's edges are not those of the border, but
    // its vertices are. The faces of a narrow strip have all of their vertices there too, and are
    // small.
    const bool bordered = 10 * edges > 6 * n || (n > 8 && 10 * vertices > 6 * n);
    if ((bordered && (outside || n > 4)) || n > largest_gap) {
      for (const Index g : orbit) hole_[g] = 1;
    }
  }
}

/// Squared deviation of a polygon's angles from the regular one; huge if it is not convex.
double FaceRepair::polygon_cost(std::span<const Index> corners) const {
  const std::size_t n = corners.size();
  const double regular = pi * static_cast<double>(n - 2) / static_cast<double>(n);
  double cost = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double a = angle(corners[k], corners[(k + 1) % n], corners[(k + n - 1) % n]);
    if (a > 1.1 * pi) cost += 1e9;  // smoothing straightens a corner that is nearly flat
    cost += (a - regular) * (a - regular);
  }
  return cost;
}

bool FaceRepair::split_once(Index h) {
  std::vector<Index> orbit;
  map_.orbit(h, orbit);
  const std::size_t n = orbit.size();
  const std::size_t piece = posy_ == 4 ? 4 : 3;  // corners of what a chord cuts off
  if (n <= piece || (posy_ == 4 && n == 5)) return false;
  double best_cost = std::numeric_limits<double>::infinity();
  std::size_t best = n;
  std::vector<Index> corners(piece), rest;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t c = 0; c < piece; ++c) corners[c] = map_.origin(orbit[(k + c) % n]);
    bool simple = true;
    for (std::size_t a = 0; a < piece; ++a) {
      for (std::size_t b = 0; b < a; ++b) simple = simple && corners[a] != corners[b];
    }
    if (!simple || map_.adjacent(corners.front(), corners.back())) continue;
    double cost = polygon_cost(corners);
    // Where this is the last cut, what is left counts as well.
    if (n == 2 * piece - 2) {
      rest.clear();
      for (std::size_t c = piece - 1; c <= n; ++c) rest.push_back(map_.origin(orbit[(k + c) % n]));
      cost += polygon_cost(rest);
    }
    if (cost < best_cost) {
      best_cost = cost;
      best = k;
    }
  }
  if (best == n) return false;
  add_edge(orbit[best], orbit[(best + piece - 1) % n]);
  return true;
}

void FaceRepair::add_hub(Index h) {
  std::vector<Index> rim;
  map_.orbit(h, rim);
  for (Index& g : rim) g = map_.origin(g);
  clusters_.append_mean(rim);
  map_.add_hub(h);
  hole_.resize(map_.halfedges(), 0);
  lines_.resize(map_.halfedges() / 2, no_index);
}

void FaceRepair::split_large() {
  // Added halfedges lie at the end, so that what a split leaves is seen again.
  for (Index h = 0; h < map_.halfedges(); ++h) {
    if (map_.removed(h) || hole_[h]) continue;
    while (split_once(h)) {
    }
    if (posy_ == 6 && map_.degree(h) > 3) add_hub(h);
  }
}

}  // namespace meshgrain
