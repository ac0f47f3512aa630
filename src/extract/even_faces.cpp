// What pair_odd_faces() does to the faces on its ways.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "extract/face_repair.h"

namespace meshgrain {

/// The direction of an edge.
Vec3 FaceRepair::along(Index h) const {
  return (clusters_.positions[map_.target(h)] - clusters_.positions[map_.origin(h)]).normalized();
}

/// Whether a line turns towards an edge that starts there as a circle of twelve edges does.
bool FaceRepair::is_corner_without(Index h) const {
  constexpr float least = 0.45f;  // sine of the turn
  const Index t = PolygonMap::twin(h);
  const Vec3 normal = (face_normal(h) + face_normal(t)).normalized();
  return normal.dot(along(map_.prev(h)).cross(along(map_.next(t)))) > least;
}

bool FaceRepair::may_join_triangles(Index h) const {
  const Index t = PolygonMap::twin(h);
  if (hole_[h] || hole_[t] || line(h) != no_index) return false;
  if (map_.degree(h) != 3 || map_.degree(t) != 3 || touches_itself(h)) return false;
  return std::ranges::all_of(std::array{h, t}, [&](Index end) {
    return map_.valence(map_.origin(end)) > 3 && (!is_last_rung(end) || is_corner_without(end));
  });
}

void FaceRepair::split_edge(Index h) {
  const Index t = PolygonMap::twin(h);
  const Index ends[2] = {map_.origin(h), map_.target(h)};
  clusters_.append_mean(ends);
  if (line(h) != no_index) clusters_.hold.back() = on_line;
  clusters_.on_border.back() = hole_[h] || hole_[t];
  map_.split_edge(h);
  hole_.push_back(hole_[h]);
  hole_.push_back(hole_[t]);
  lines_.push_back(line(h));
}

/// Whether a line bends so much along an edge that it needs both of its ends: as much as a circle
/// of twelve edges does.
bool FaceRepair::is_bent(Index h) const {
  constexpr float most = 0.5f;  // cosine of two turns
  Vec3 before = along(h), after = before;
  map_.for_each_leaving(map_.origin(h), [&](Index g) {
    if (g != h && line(g) == line(h)) before = along(PolygonMap::twin(g));
  });
  const Index back = PolygonMap::twin(h);
  map_.for_each_leaving(map_.target(h), [&](Index g) {
    if (g != back && line(g) == line(h)) after = along(g);
  });
  return before.dot(after) < most;
}

bool FaceRepair::may_contract_line(Index h) const {
  const Index ends[2] = {map_.origin(h), map_.target(h)};
  if (hole_[h] || hole_[PolygonMap::twin(h)] || line(h) == no_index || map_.degree(h) != 3)
    return false;
  if (clusters_.on_border[ends[0]] || clusters_.on_border[ends[1]]) return false;
  if (clusters_.hold[ends[0]] == at_corner && clusters_.hold[ends[1]] == at_corner) return false;
  if (is_bent(h)) return false;
  std::vector<Index> apexes;
  for (const Index side : {h, PolygonMap::twin(h)}) {
    if (map_.degree(side) != 3) continue;
    if (line(map_.next(side)) != no_index || line(map_.prev(side)) != no_index) return false;
    apexes.push_back(map_.target(map_.next(side)));
    if (map_.valence(apexes.back()) <= 3) return false;
  }
  // The other faces around the ends must have nothing but these in common, or they would touch.
  const auto for_corners = [&](Index start, const auto& body) {
    for (Index g = map_.around(map_.around(start)); g != start; g = map_.around(g)) {
      for (Index k = g; map_.next(k) != g; k = map_.next(k)) body(map_.target(k));
    }
  };
  std::vector<Index> near;
  for_corners(h, [&](Index v) { near.push_back(v); });
  bool apart = true;
  for_corners(PolygonMap::twin(h), [&](Index v) {
    apart = apart && (std::ranges::count(near, v) == 0 || std::ranges::count(apexes, v) > 0);
  });
  return apart;
}

void FaceRepair::contract_line(Index h) {
  const bool origin_stays = clusters_.hold[map_.target(h)] != at_corner;
  contract(origin_stays ? h : PolygonMap::twin(h));
}

/// How bad an edge is that cuts a quad off a face, from one of its corners to the third after it.
double FaceRepair::chord_cost(std::span<const Index> orbit, std::size_t from) const {
  constexpr double of_straight_angle = 100, of_doublet = 100, of_irregular = 0.5, worst_shape = 30;
  const std::size_t n = orbit.size();
  double cost = 0;
  const auto add_face = [&](std::size_t first, std::size_t count) {
    std::vector<Index> corners;
    for (std::size_t k = first; k < first + count; ++k) {
      corners.push_back(map_.origin(orbit[k % n]));
      const bool is_end = k == first || k + 1 == first + count;
      const bool straight =
          line(orbit[k % n]) != no_index && line(orbit[(k + n - 1) % n]) != no_index;
      if (is_end) continue;
      if (straight && clusters_.hold[corners.back()] != at_corner) cost += of_straight_angle;
      // The other side has no edge to give any more.
      const Index beyond = PolygonMap::twin(orbit[k % n]);
      if (map_.valence(corners.back()) == 2 && (hole_[beyond] || map_.degree(beyond) == 4)) {
        cost += of_doublet;
      }
    }
    cost += std::min(polygon_cost(corners), worst_shape);
  };
  add_face(from, 4);
  add_face(from + 3, n - 2);
  for (const std::size_t end : {from, from + 3}) {
    const Index v = map_.origin(orbit[end % n]);
    const int excess = static_cast<int>(map_.valence(v)) - regular_valence(clusters_.on_border[v]);
    cost += of_irregular * (2 * excess + 1);  // of squares
  }
  return cost;
}

void FaceRepair::cut_into_quads(Index h) {
  std::vector<Index> orbit;
  for (map_.orbit(h, orbit); orbit.size() > 4; map_.orbit(h, orbit)) {
    const std::size_t n = orbit.size();
    std::size_t best = n;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < n; ++k) {
      const Index a = map_.origin(orbit[k]), b = map_.origin(orbit[(k + 3) % n]);
      if (a == b || map_.adjacent(a, b)) continue;
      const double cost = chord_cost(orbit, k);
      if (cost >= least) continue;
      least = cost;
      best = k;
    }
    if (best == n) {
      // Joined outside already, all of them: every other corner gets an edge to the middle.
      const auto spokes = static_cast<Index>(map_.halfedges());
      add_hub(h);
      for (Index k = 1; k < n; k += 2) map_.remove_edge(spokes + 2 * k);
      return;
    }
    const Index chord = add_edge(orbit[best], orbit[(best + 3) % n]);
    // The rest may be on either side of it.
    h = map_.degree(chord) > 4 ? chord : PolygonMap::twin(chord);
  }
}

}  // namespace meshgrain
