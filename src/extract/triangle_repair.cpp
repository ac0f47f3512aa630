#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "extract/face_repair.h"
#include "extract/link_condition.h"

namespace meshgrain {

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

/// Contracts an edge between triangles: the target of h vanishes, and so do the triangles beside
/// it.
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

/// By how much turning an edge brings the valences around it nearer to 6 (the sum of the squared
/// differences); 0 if it must stay.
int FaceRepair::flip_gain(Index h) const {
  const Index t = PolygonMap::twin(h);
  if (map_.removed(h) || hole_[h] || hole_[t] || map_.degree(h) != 3 || map_.degree(t) != 3)
    return 0;
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
  const double most = 0.92 * std::numbers::pi;
  const bool convex =
      angle(ends[0], tips[1], tips[0]) < most && angle(ends[1], tips[0], tips[1]) < most;
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

}  // namespace meshgrain
