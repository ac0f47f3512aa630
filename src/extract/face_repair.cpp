#include "extract/face_repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "extract/link_condition.h"

namespace meshgrain {

using std::numbers::pi;

FaceRepair::FaceRepair(PolygonMap& map, Clusters& clusters, int posy,
                       std::vector<std::uint8_t> holes)
    : map_(map), clusters_(clusters), posy_(posy), hole_(std::move(holes)) {}

/// The angle at v from one neighbour counterclockwise to another, in the tangent plane: 0 to 2 pi.
double FaceRepair::angle(Index v, Index from, Index to) const {
  const Vec3& n = clusters_.normals[v];
  const Vec3 a = clusters_.positions[from] - clusters_.positions[v], b = clusters_.positions[to] - clusters_.positions[v];
  const double angle = std::atan2(n.dot(a.cross(b)), a.dot(b) - n.dot(a) * n.dot(b));
  return angle < 0 ? angle + 2 * pi : angle;
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
}

void FaceRepair::cut_pinches() {
  std::vector<Index> orbit;
  std::vector<Index> corner_of(clusters_.positions.size(), no_index);  // in the current orbit
  for (Index h = 0; h < map_.halfedges(); ++h) {
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
    // Where the lattice runs askew to the border, the gap's edges are not those of the border, but its
    // vertices are. The faces of a narrow strip have all of their vertices there too, and are small.
    const bool bordered = 10 * edges > 6 * n || (n > 8 && 10 * vertices > 6 * n);
    if ((bordered && (outside || n > 4)) || n > largest_gap) {
      for (const Index g : orbit) hole_[g] = 1;
    }
  }
}

/// 1 for an equilateral triangle, 0 for a degenerate one, negative for one turned over.
double FaceRepair::triangle_quality(Index a, Index b, Index c) const {
  const Vec3 &p = clusters_.positions[a], &q = clusters_.positions[b], &r = clusters_.positions[c];
  const Vec3 normal = (q - p).cross(r - p);
  const Vec3 up = clusters_.normals[a] + clusters_.normals[b] + clusters_.normals[c];
  const double squares = (q - p).squaredNorm() + (r - q).squaredNorm() + (p - r).squaredNorm();
  if (!(squares > 0)) return 0;
  const double area = 2 * std::numbers::sqrt3 * normal.norm() / squares;
  return normal.dot(up) < 0 ? -area : area;
}

/// The least quality of the triangles around a vertex.
double FaceRepair::star_quality(Index vertex) const {
  double worst = 1;
  const Index start = map_.leaving(vertex);
  Index h = start;
  do {
    if (!hole_[h]) {
      worst = std::min(worst, triangle_quality(vertex, map_.target(h), map_.target(map_.next(h))));
    }
    h = map_.around(h);
  } while (h != start);
  return worst;
}

/// The least quality of the triangles around the target of h once they are at its origin.
double FaceRepair::contracted_quality(Index h) const {
  const Index t = PolygonMap::twin(h), to = map_.origin(h);
  double worst = 1;
  for (Index g = map_.around(t); g != t; g = map_.around(g)) {
    const Index c = map_.target(g), d = map_.target(map_.next(g));
    if (hole_[g] || c == to || d == to) continue;
    worst = std::min(worst, triangle_quality(to, c, d));
  }
  return worst;
}

/// Contracts an edge between triangles: the target of h vanishes, and so do the triangles beside it.
void FaceRepair::contract(Index h) {
  const Index t = PolygonMap::twin(h);
  const Index gone[2] = {map_.next(h), map_.prev(t)}, kept[2] = {map_.prev(h), map_.next(t)};
  const bool inside[2] = {!hole_[h], !hole_[t]};
  map_.contract_edge(h);
  for (int side = 0; side < 2; ++side) {
    if (!inside[side]) continue;
    hole_[kept[side]] = hole_[PolygonMap::twin(gone[side])];
    map_.remove_edge(gone[side]);
  }
}

void FaceRepair::untangle() {
  LinkCondition link;
  for (int round = 0; round < 10; ++round) {
    bool changed = false;
    for (Index v = 0; v < map_.vertices(); ++v) {
      if (map_.leaving(v) == no_index) continue;
      const double before = star_quality(v);
      if (before > 0.1) continue;
      const bool rim = clusters_.on_border[v];
      Index best = no_index;
      double best_quality = before + 0.05;
      if (!rim) {
        const Vec3 old = clusters_.positions[v];
        Vec3 sum = Vec3::Zero();
        const Index start = map_.leaving(v);
        Index h = start;
        do {
          sum += clusters_.positions[map_.target(h)];
          h = map_.around(h);
        } while (h != start);
        clusters_.positions[v] = sum / static_cast<float>(map_.valence(v));
        if (const double moved = star_quality(v); moved > best_quality) {
          changed = true;
          continue;
        }
        clusters_.positions[v] = old;
      }
      const Index start = map_.leaving(v);
      Index h = start;
      do {
        const Index into = PolygonMap::twin(h);  // from the neighbour to v, which would vanish
        const bool along = hole_[h] || hole_[into];
        if ((!rim || along) && link.holds(map_, hole_, into)) {
          if (const double quality = contracted_quality(into); quality > best_quality) {
            best_quality = quality;
            best = into;
          }
        }
        h = map_.around(h);
      } while (h != start);
      if (best == no_index) continue;
      contract(best);
      changed = true;
    }
    if (!changed) return;
  }
}

void FaceRepair::contract_short_edges(const EdgeLength& edge_length,
                                      const std::vector<float>& cover) {
  LinkCondition link;
  struct Candidate {
    float length;
    Index h;  // its target vanishes
    bool operator<(const Candidate& o) const {
      return std::tie(length, h) < std::tie(o.length, o.h);
    }
  };
  for (bool again = true; again;) {
    again = false;
    std::vector<Candidate> candidates;
    for (Index h = 0; h < map_.halfedges(); ++h) {
      if (map_.removed(h)) continue;
      const Index a = map_.origin(h), b = map_.target(h);
      if (cover[b] > cover[a] || (cover[a] == cover[b] && b < a)) continue;
      const float length = (clusters_.positions[a] - clusters_.positions[b]).norm() /
                           edge_length[clusters_.nodes[a]];
      if (length < (cover[b] < 0.1f ? 0.8f : 0.4f)) candidates.push_back({length, h});
    }
    std::sort(candidates.begin(), candidates.end());
    for (const Candidate& c : candidates) {
      if (map_.removed(c.h) || !link.holds(map_, hole_, c.h)) continue;
      const Index t = PolygonMap::twin(c.h);
      // A vertex on the border stays there.
      if (clusters_.on_border[map_.origin(t)] && !clusters_.on_border[map_.origin(c.h)]) continue;
      // No triangle may turn over by it, unless it was worse before.
      const double after = contracted_quality(c.h);
      if (after < 0.1 && after < star_quality(map_.origin(t))) continue;
      contract(c.h);
      again = true;
    }
  }
}

void FaceRepair::flip_bad_triangles() {
  for (int round = 0; round < 20; ++round) {
    bool changed = false;
    for (Index h = 0; h < map_.halfedges(); h += 2) {
      const Index t = PolygonMap::twin(h);
      if (map_.removed(h) || hole_[h] || hole_[t]) continue;
      const Index a = map_.origin(h), b = map_.origin(t);
      const Index c = map_.origin(map_.prev(h)), d = map_.origin(map_.prev(t));
      const double before = std::min(triangle_quality(a, b, c), triangle_quality(b, a, d));
      if (before > 0.3 || c == d || map_.adjacent(c, d)) continue;
      if (map_.valence(a) <= 3 || map_.valence(b) <= 3) continue;
      const double after = std::min(triangle_quality(a, d, c), triangle_quality(d, b, c));
      if (after < before + 0.05) continue;
      const Index from = map_.prev(h), to = map_.prev(t);
      map_.remove_edge(h);
      map_.add_edge(from, to);
      hole_.resize(map_.halfedges(), 0);
      changed = true;
    }
    if (!changed) return;
  }
}

void FaceRepair::remove_doublets() {
  for (bool again = true; again;) {
    again = false;
    for (Index v = 0; v < clusters_.positions.size(); ++v) {
      const Index h = map_.leaving(v);
      if (h == no_index || map_.valence(v) != 2) continue;
      const Index g = map_.around(h);
      if (hole_[h] || hole_[g]) continue;
      // The faces must share nothing but the two edges, or what they become would touch itself.
      std::vector<Index> merged;
      for (Index k = map_.next(h); k != map_.prev(h); k = map_.next(k)) merged.push_back(map_.target(k));
      for (Index k = map_.next(g); k != map_.prev(g); k = map_.next(k)) merged.push_back(map_.target(k));
      std::sort(merged.begin(), merged.end());
      if (merged.size() < 3 || std::adjacent_find(merged.begin(), merged.end()) != merged.end()) {
        continue;
      }
      // Both ends lose an edge.
      if (map_.valence(map_.target(h)) <= 3 || map_.valence(map_.target(g)) <= 3) continue;
      map_.remove_edge(h);
      map_.remove_edge(g);
      again = true;
    }
  }
}

double FaceRepair::removal_cost(Index h) const {
  std::vector<Index> corners = union_halfedges(h);
  for (Index& corner : corners) corner = map_.origin(corner);
  std::vector<Index> sorted = corners;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return 1e30;
  return polygon_cost(corners);
}

void FaceRepair::remove_diagonals(std::span<const std::array<int, 2>> jumps) {
  std::vector<std::pair<double, Index>> candidates;
  for (Index h = 0; h < 2 * jumps.size(); h += 2) {
    const auto& t = jumps[h / 2];
    if (std::abs(t[0]) != 1 || std::abs(t[1]) != 1) continue;
    if (map_.removed(h) || hole_[h] || hole_[h + 1]) continue;
    const double cost = removal_cost(h);
    if (cost < 1e9) candidates.emplace_back(cost, h);
  }
  std::sort(candidates.begin(), candidates.end());
  for (const auto& [cost, h] : candidates) {
    if (map_.degree(h) != 3 || map_.degree(h + 1) != 3) continue;
    if (map_.valence(map_.origin(h)) <= 3 || map_.valence(map_.target(h)) <= 3) continue;
    if (removal_cost(h) < 1e9) map_.remove_edge(h);
  }
}

/// By how much turning an edge brings the valences around it nearer to 6 (the sum of the squared
/// differences); 0 if it must stay.
int FaceRepair::flip_gain(Index h) const {
  const Index t = PolygonMap::twin(h);
  if (map_.removed(h) || hole_[h] || hole_[t] || map_.degree(h) != 3 || map_.degree(t) != 3) return 0;
  const Index ends[2] = {map_.origin(h), map_.origin(t)};
  const Index tips[2] = {map_.origin(map_.prev(h)), map_.origin(map_.prev(t))};
  if (tips[0] == tips[1] || map_.adjacent(tips[0], tips[1])) return 0;
  int gain = 0;
  const auto add = [&](Index v, int change) {
    int excess = 0;
    Index g = map_.leaving(v);
    const Index start = g;
    bool inner = true;
    do {
      ++excess;
      inner = inner && !hole_[g];
      g = map_.around(g);
    } while (g != start);
    excess -= inner ? 6 : 4;
    gain += excess * excess - (excess + change) * (excess + change);
  };
  for (const Index v : ends) add(v, -1);
  for (const Index v : tips) add(v, 1);
  if (gain <= 0) return 0;
  // The two triangles must stay triangles: the quad around them convex, with room to spare.
  const double most = 0.92 * pi;
  const bool convex = angle(ends[0], tips[1], tips[0]) < most && angle(ends[1], tips[0], tips[1]) < most;
  return convex ? gain : 0;
}

void FaceRepair::flip_edges() {
  for (bool again = true; again;) {
    again = false;
    std::vector<std::pair<int, Index>> candidates;
    for (Index h = 0; h < map_.halfedges(); h += 2) {
      if (const int gain = flip_gain(h); gain > 0) candidates.emplace_back(-gain, h);
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [loss, h] : candidates) {
      if (flip_gain(h) != -loss) continue;
      const Index a = map_.prev(h), b = map_.prev(PolygonMap::twin(h));
      map_.remove_edge(h);
      map_.add_edge(a, b);
      hole_.resize(map_.halfedges(), 0);
      again = true;
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
  map_.add_edge(orbit[best], orbit[(best + piece - 1) % n]);
  hole_.resize(map_.halfedges(), 0);
  return true;
}

void FaceRepair::add_hub(Index h) {
  std::vector<Index> rim;
  map_.orbit(h, rim);
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  for (const Index g : rim) {
    position += clusters_.positions[map_.origin(g)];
    normal += clusters_.normals[map_.origin(g)];
  }
  const Index first = map_.origin(rim[0]);
  clusters_.positions.push_back(position / static_cast<float>(rim.size()));
  const float length = normal.norm();
  clusters_.normals.push_back(length > 1e-6f ? Vec3(normal / length) : clusters_.normals[first]);
  clusters_.nodes.push_back(clusters_.nodes[first]);
  clusters_.on_border.push_back(0);
  map_.add_hub(h);
  hole_.resize(map_.halfedges(), 0);
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
