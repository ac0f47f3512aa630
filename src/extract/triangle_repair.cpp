#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>

#include "extract/face_repair.h"
#include "util/collect.h"

namespace meshgrain {

/// Contracts an edge: its target vanishes, and so do the triangles beside it.
void FaceRepair::contract(Index h) {
  const Index t = PolygonMap::twin(h);
  const Index gone[2] = {map_.next(h), map_.prev(t)}, kept[2] = {map_.prev(h), map_.next(t)};
  const bool vanishes[2] = {!hole_[h] && map_.degree(h) == 3, !hole_[t] && map_.degree(t) == 3};
  map_.contract_edge(h);
  for (int side = 0; side < 2; ++side) {
    if (!vanishes[side]) continue;
    hole_[kept[side]] = hole_[PolygonMap::twin(gone[side])];
    map_.remove_edge(gone[side]);
  }
}

/// By how much turning an edge brings the valences around it nearer to 6 (the sum of the squared
/// differences); 0 if it must stay.
int FaceRepair::flip_gain(Index h) const {
  const Index t = PolygonMap::twin(h);
  if (map_.removed(h) || hole_[h] || hole_[t] || line(h) != no_index) return 0;
  if (map_.degree(h) != 3 || map_.degree(t) != 3) return 0;
  if (is_last_rung(h) || is_last_rung(t)) return 0;
  const Index ends[2] = {map_.origin(h), map_.origin(t)};
  const Index tips[2] = {map_.origin(map_.prev(h)), map_.origin(map_.prev(t))};
  if (tips[0] == tips[1] || map_.adjacent(tips[0], tips[1])) return 0;
  int gain = 0;
  const auto add = [&](Index v, int change) {
    int excess = 0;
    bool inner = true;
    map_.for_each_leaving(v, [&](Index g) {
      ++excess;
      inner = inner && !hole_[g];
    });
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

void FaceRepair::flip_edges(const Context& context) {
  for (bool again = true; again;) {
    again = false;
    using Candidate = std::pair<int, Index>;
    const auto look = [&](std::size_t begin, std::size_t end, std::vector<Candidate>& out) {
      for (auto e = static_cast<Index>(begin); e < end; ++e) {
        if (const int gain = flip_gain(2 * e); gain > 0) out.emplace_back(-gain, 2 * e);
      }
    };
    std::vector<Candidate> candidates = collect<Candidate>(map_.halfedges() / 2, look, context);
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [loss, h] : candidates) {
      if (flip_gain(h) != -loss) continue;
      const Index a = map_.prev(h), b = map_.prev(PolygonMap::twin(h));
      map_.remove_edge(h);
      add_edge(a, b);
      again = true;
    }
  }
}

std::optional<int> FaceRepair::contraction_gain(Index h) {
  if (map_.removed(h)) return std::nullopt;
  const Index t = PolygonMap::twin(h), a = map_.origin(h), b = map_.target(h);
  const auto regular = [&](Index v) { return clusters_.on_border[v] ? 4 : 6; };
  const auto irregular = [&](Index v, int change) {
    return static_cast<int>(map_.valence(v)) + change != regular(v);
  };
  if (clusters_.on_border[b] && !clusters_.on_border[a]) return std::nullopt;
  if (clusters_.hold[b] != free_vertex) return std::nullopt;
  if (!link_.holds(map_, hole_, h)) return std::nullopt;
  int sides = 0, gain = irregular(a, 0) + irregular(b, 0);
  for (const Index side : {h, t}) {
    if (hole_[side]) continue;
    ++sides;
    const Index apex = map_.target(map_.next(side));
    // Of its two edges to the ends of h, that to b goes.
    const Index going = side == h ? PolygonMap::twin(map_.next(h)) : map_.prev(t);
    if (map_.valence(apex) <= 3 || is_last_rung(going)) return std::nullopt;
    gain += irregular(apex, 0) - irregular(apex, -1);
  }
  if (sides < 2) return std::nullopt;
  return gain - irregular(a, static_cast<int>(map_.valence(b)) - 4);
}

std::size_t FaceRepair::contract_edges(std::size_t count, const Context& context) {
  const std::size_t done = change_best(
      count, std::numeric_limits<int>::min(), [&](Index h, int) { return contraction_gain(h); },
      [&](Index h) { return distance(map_.origin(h), map_.target(h)); },
      [&](Index h) {
        const Index a = map_.origin(h), b = map_.target(h);
        if (!clusters_.on_border[a] && clusters_.hold[a] == free_vertex) {
          clusters_.positions[a] = 0.5f * (clusters_.positions[a] + clusters_.positions[b]);
        }
        contract(h);
      },
      context);
  flip_edges(context);
  return done;
}

}  // namespace meshgrain
