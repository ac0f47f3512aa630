#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

#include "extract/face_repair.h"
#include "util/collect.h"
#include "util/index_marks.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

bool has_repeats(std::vector<Index> values) {
  std::sort(values.begin(), values.end());
  return std::adjacent_find(values.begin(), values.end()) != values.end();
}

}  // namespace

void FaceRepair::remove_doublets() {
  for (bool again = true; again;) {
    again = false;
    for (Index v = 0; v < clusters_.positions.size(); ++v) {
      const Index h = map_.leaving(v);
      if (h == no_index || map_.valence(v) != 2 || clusters_.hold[v] != free_vertex) continue;
      const Index g = map_.around(h);
      if (hole_[h] || hole_[g]) continue;
      if (is_last_rung(PolygonMap::twin(h)) || is_last_rung(PolygonMap::twin(g))) continue;
      // The faces must share nothing but the two edges, or what they become would touch itself.
      std::vector<Index> merged;
      for (Index k = map_.next(h); k != map_.prev(h); k = map_.next(k))
        merged.push_back(map_.target(k));
      for (Index k = map_.next(g); k != map_.prev(g); k = map_.next(k))
        merged.push_back(map_.target(k));
      if (merged.size() < 3 || has_repeats(merged)) continue;
      // Both ends lose an edge.
      if (map_.valence(map_.target(h)) <= 3 || map_.valence(map_.target(g)) <= 3) continue;
      map_.remove_edge(h);
      map_.remove_edge(g);
      again = true;
    }
  }
}

void FaceRepair::remove_diagonals(std::span<const Jump> jumps, const Context& context) {
  const auto is_diagonal = [&](Index h) {
    const auto& t = jumps[h / 2].t;
    return std::abs(t[0]) == 1 && std::abs(t[1]) == 1;
  };
  // Of the triangle left of h; one that is half of a square has one.
  const auto diagonals = [&](Index h) {
    return is_diagonal(h) + is_diagonal(map_.next(h)) + is_diagonal(map_.prev(h));
  };
  struct Diagonal {
    Index h;
    int beside;  // diagonals of the triangles on both sides
  };
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Diagonal>& out) {
    for (auto e = static_cast<Index>(begin); e < end; ++e) {
      const Index h = 2 * e, t = h + 1;
      if (map_.removed(h) || hole_[h] || hole_[t] || !is_diagonal(h)) continue;
      out.push_back({h, diagonals(h) + diagonals(t)});
    }
  };
  const std::vector<Diagonal> all = collect<Diagonal>(jumps.size(), look, context);
  for (const int most : {2, 3, 4}) {
    const std::size_t most_corners = most == 2 ? 4 : 5;
    for (const auto& [h, beside] : all) {
      if (beside > most || map_.removed(h)) continue;
      const std::size_t corners = map_.degree(h) + map_.degree(h + 1) - 2;
      if (corners <= most_corners && may_remove(h)) map_.remove_edge(h);
    }
  }
}

bool FaceRepair::is_irregular(Index vertex, int change) const {
  return static_cast<int>(map_.valence(vertex)) + change !=
         regular_valence(clusters_.on_border[vertex]);
}

bool FaceRepair::touches_itself(Index h) const {
  std::vector<Index> corners = union_halfedges(h);
  for (Index& corner : corners) corner = map_.origin(corner);
  return has_repeats(corners);
}

std::vector<Index> FaceRepair::union_halfedges(Index h) const {
  const Index t = PolygonMap::twin(h);
  std::vector<Index> halfedges;
  for (Index g = map_.next(h); g != h; g = map_.next(g)) halfedges.push_back(g);
  for (Index g = map_.next(t); g != t; g = map_.next(g)) halfedges.push_back(g);
  return halfedges;
}

bool FaceRepair::leaves_straight_angle(const std::vector<Index>& around, int from, int to) const {
  if (!stays(map_.origin(around[from])) || !stays(map_.origin(around[to]))) return false;
  const auto n = static_cast<int>(around.size());
  for (int turn = 0; turn < 2; ++turn, std::swap(from, to)) {  // the faces on both sides
    const Index a = map_.origin(around[from]), b = map_.origin(around[to]);
    Vec3 normal = Vec3::Zero();
    for (int k = from; k != to; k = (k + 1) % n) {
      const Vec3& base = clusters_.positions[a];
      normal += (clusters_.positions[map_.origin(around[k])] - base)
                    .cross(clusters_.positions[map_.target(around[k])] - base);
    }
    const Index first = around[from], last = around[(to + n - 1) % n];
    if (is_held(first) && is_straight(a, map_.target(first), b, normal)) return true;
    if (is_held(last) && is_straight(b, a, map_.origin(last), normal)) return true;
  }
  return false;
}

FaceRepair::EdgeChange FaceRepair::best_change(Index h) const {
  EdgeChange best;
  const Index t = PolygonMap::twin(h);
  if (map_.removed(h) || hole_[h] || hole_[t] || line(h) != no_index) return best;
  const auto a = static_cast<int>(map_.degree(h)), b = static_cast<int>(map_.degree(t));
  const int n = a + b - 2;
  if (n > 7) return best;
  const Index ends[2] = {map_.origin(h), map_.origin(t)};
  int gain_of_removal = (a != 4) + (b != 4);
  for (const Index v : ends) {
    const int excess = static_cast<int>(map_.valence(v)) - regular_valence(clusters_.on_border[v]);
    if (excess < 0) return best;
    gain_of_removal += (excess != 0) - (excess != 1);
  }
  // Another edge in its place can gain one at each of its ends: most are done with here.
  if (gain_of_removal <= -2) return best;

  const bool needs_rung[2] = {is_last_rung(h), is_last_rung(t)};
  const std::vector<Index> around = union_halfedges(h);
  std::vector<Index> corners;
  for (const Index g : around) corners.push_back(map_.origin(g));
  if (has_repeats(corners)) return best;
  const auto loses = [&](Index v) { return v == ends[0] || v == ends[1]; };
  const auto keep_better = [&](int gain, double cost, int from, int to) {
    if (cost >= 1e9) return;
    if (gain > best.gain || (gain == best.gain && gain > 0 && cost < best.cost)) {
      best = {gain, cost, h, from, to};
    }
  };
  if (!needs_rung[0] && !needs_rung[1] && n <= 5 && gain_of_removal - (n != 4) > 0) {
    keep_better(gain_of_removal - (n != 4), polygon_cost(corners), -1, -1);
  }
  // Or another edge in its place: one that cuts off a quad.
  for (int from = 0; from < n; ++from) {
    for (int to = from + 2; to <= std::min(n - 1, from + n - 2); ++to) {
      const int left = to - from + 1, right = n - left + 2;
      if (left != 4 && right != 4) continue;
      const auto ends_at = [&](Index v) { return corners[from] == v || corners[to] == v; };
      if (needs_rung[0] && !ends_at(ends[0])) continue;
      if (needs_rung[1] && !ends_at(ends[1])) continue;
      int gain = gain_of_removal - (left != 4) - (right != 4);
      for (const Index v : {corners[from], corners[to]}) {
        const int before = loses(v) ? -1 : 0;
        gain += is_irregular(v, before) - is_irregular(v, before + 1);
      }
      if (gain <= 0 || gain < best.gain || map_.adjacent(corners[from], corners[to])) continue;
      if (leaves_straight_angle(around, from, to)) continue;
      std::vector<Index> face(corners.begin() + from, corners.begin() + to + 1);
      double cost = polygon_cost(face);
      face.assign(corners.begin() + to, corners.end());
      face.insert(face.end(), corners.begin(), corners.begin() + from + 1);
      cost += polygon_cost(face);
      keep_better(gain, cost, from, to);
    }
  }
  return best;
}

void FaceRepair::apply(const EdgeChange& change) {
  const std::vector<Index> halfedges = union_halfedges(change.h);
  map_.remove_edge(change.h);
  if (change.from < 0) return;
  add_edge(halfedges[change.from], halfedges[change.to]);
}

void FaceRepair::improve_edges(const Context& context) {
  // Every change lowers a count, so this ends by itself.
  for (;;) {
    const auto look = [&](std::size_t begin, std::size_t end, std::vector<EdgeChange>& out) {
      for (auto e = static_cast<Index>(begin); e < end; ++e) {
        if (const EdgeChange change = best_change(2 * e); change.gain > 0) out.push_back(change);
      }
    };
    std::vector<EdgeChange> changes = collect<EdgeChange>(map_.halfedges() / 2, look, context);
    if (changes.empty()) return;
    std::sort(changes.begin(), changes.end(), [](const EdgeChange& x, const EdgeChange& y) {
      return std::tie(y.gain, x.cost, x.h) < std::tie(x.gain, y.cost, y.h);
    });
    bool applied = false;
    for (const EdgeChange& change : changes) {
      // What lies beside it may have changed since; the first is always as it was.
      const EdgeChange now = best_change(change.h);
      if (now.gain < change.gain) continue;
      apply(now);
      applied = true;
    }
    if (!applied) return;
  }
}

std::optional<int> FaceRepair::closing_gain(Index h, int least) const {
  if (map_.removed(h) || hole_[h] || map_.degree(h) != 4) return std::nullopt;
  const Index across = map_.next(map_.next(h));
  const Index a = map_.origin(h), c = map_.origin(across);
  const Index sides[2] = {map_.origin(map_.next(h)), map_.origin(map_.next(across))};
  for (const Index v : {a, c}) {
    if (clusters_.on_border[v] || clusters_.hold[v] != free_vertex) return std::nullopt;
  }
  const auto valence = static_cast<int>(map_.valence(a) + map_.valence(c)) - 2;
  int gain = is_irregular(a, 0) + is_irregular(c, 0) - (valence != 4);
  for (const Index v : sides) {
    if (static_cast<int>(map_.valence(v)) < regular_valence(clusters_.on_border[v]))
      return std::nullopt;
    // The last edge that parts an angle of the border which nothing can bend.
    const bool fixed = clusters_.on_border[v] && clusters_.hold[v] == at_corner;
    if (fixed && map_.valence(v) <= 3) return std::nullopt;
    gain += is_irregular(v, 0) - is_irregular(v, -1);
  }
  if (gain < least) return std::nullopt;
  return are_apart(h) ? std::optional(gain) : std::nullopt;
}

bool FaceRepair::are_apart(Index h) const {
  const Index across = map_.next(map_.next(h));
  const Index sides[2] = {map_.target(h), map_.target(across)};
  std::vector<Index> near;
  const auto for_faces = [&](Index start, const auto& body) {
    for (Index g = map_.around(start); g != start; g = map_.around(g)) {
      for (Index k = map_.next(g); k != g; k = map_.next(k)) body(map_.origin(k));
    }
  };
  for_faces(h, [&](Index v) { near.push_back(v); });
  std::sort(near.begin(), near.end());
  bool apart = true;
  for_faces(across, [&](Index v) {
    const bool side = v == sides[0] || v == sides[1];
    apart = apart && (side || !std::binary_search(near.begin(), near.end(), v));
  });
  return apart;
}

void FaceRepair::close_quad(Index h) {
  const Index across = map_.next(map_.next(h));
  const Index a = map_.origin(h), c = map_.origin(across);
  if (is_loose(a)) {
    clusters_.positions[a] = 0.5f * (clusters_.positions[a] + clusters_.positions[c]);
  }
  contract(add_edge(h, across));
}

bool FaceRepair::may_close(Index h) const {
  const Index across = map_.next(map_.next(h));
  if (!is_loose(map_.origin(across))) return false;
  for (const Index side : {map_.target(h), map_.target(across)}) {
    const std::size_t least = clusters_.hold[side] == free_vertex ? 2 : 3;
    if (map_.valence(side) <= least) return false;
  }
  return are_apart(h);
}

std::vector<Index> FaceRepair::ways_to_close(Index face) const {
  std::vector<Index> around;
  map_.orbit(face, around);
  for (Index& h : around) h = PolygonMap::twin(h);
  around.push_back(face);
  std::vector<std::pair<float, Index>> ways;
  for (Index h : around) {
    if (hole_[h] || map_.degree(h) != 4) continue;
    for (int corner = 0; corner < 4; ++corner, h = map_.next(h)) {
      if (!may_close(h)) continue;
      const Index a = map_.origin(h), c = map_.target(map_.next(h));
      ways.push_back({(clusters_.positions[a] - clusters_.positions[c]).norm(), h});
    }
  }
  std::sort(ways.begin(), ways.end());
  std::vector<Index> result;
  for (const auto& [distance, h] : ways) result.push_back(h);
  return result;
}

bool FaceRepair::may_turn(Index h, int from) const {
  const Index t = PolygonMap::twin(h);
  if (hole_[h] || hole_[t] || map_.degree(h) != 4 || map_.degree(t) != 4) return false;
  if (!may_remove(h) || touches_itself(h)) return false;
  const std::vector<Index> around = union_halfedges(h);  // the edge was from its corner 3 to 0
  return !map_.adjacent(map_.origin(around[from]), map_.origin(around[from + 3]));
}

std::vector<FaceRepair::EdgeChange> FaceRepair::ways_to_turn(Index face) const {
  std::vector<EdgeChange> ways;
  map_.for_orbit(face, [&](Index h) {
    for (const int from : {1, 2}) {
      if (may_turn(h, from)) ways.push_back({.h = h, .from = from, .to = from + 3});
    }
  });
  return ways;
}

std::array<std::array<Index, 4>, 2> FaceRepair::turned(const EdgeChange& way) const {
  std::vector<Index> corners = union_halfedges(way.h);
  for (Index& corner : corners) corner = map_.origin(corner);
  std::ranges::rotate(corners, corners.begin() + way.from);
  return {{{corners[0], corners[1], corners[2], corners[3]},
           {corners[3], corners[4], corners[5], corners[0]}}};
}

void FaceRepair::close_quads(const Context& context) {
  IndexMarks marks;  // halfedges to look at: most quads need not be
  const auto mark_faces = [&](Index corner) {
    map_.for_each_leaving(map_.origin(corner), [&](Index face) {
      if (!hole_[face]) map_.for_orbit(face, [&](Index h) { marks.set(h); });
    });
  };
  const auto gains = [&](Index h) { return closing_gain(h, 1).has_value(); };
  for (const Index h : indices_where(map_.halfedges(), gains, context)) marks.set(h);
  for (bool again = true; std::exchange(again, false);) {
    const auto count = static_cast<Index>(map_.halfedges());
    for (Index h = marks.take(0, count); h != no_index; h = marks.take(h + 1, count)) {
      if (!gains(h)) continue;
      const Index kept = map_.origin(h);
      close_quad(h);
      // The corners of the faces there have other neighbours now.
      map_.for_each_leaving(kept, [&](Index face) { map_.for_orbit(face, mark_faces); });
      again = true;
    }
  }
}

bool FaceRepair::may_open(Index vertex) const {
  // All pairs of edges are tried, which would take long at a pole of thousands.
  constexpr std::size_t most = 30;
  return !clusters_.on_border[vertex] && clusters_.hold[vertex] != at_corner &&
         map_.valence(vertex) <= most;
}

std::optional<FaceRepair::Opening> FaceRepair::opening_from(Index first, int least) const {
  const Index vertex = map_.origin(first);
  const auto n = static_cast<int>(map_.valence(vertex));
  const auto excess = [&](Index v) {
    return static_cast<int>(map_.valence(v)) - regular_valence(clusters_.on_border[v]);
  };
  const auto ends_well = [&](Index h) { return clusters_.hold[map_.target(h)] != at_corner; };
  std::optional<Opening> best;
  if (!ends_well(first)) return best;
  Index last = first;
  for (int k = 1; k + 2 <= n; ++k) {    // edges that go
    if (line(last) != no_index) break;  // those of lines stay
    last = map_.around(last);
    if (k == 1 || !ends_well(last)) continue;
    Opening opening{0, 0, first, last};
    const auto change = [&](int before, int after) {
      opening.gain += (before != 0) - (after != 0);
      opening.squares += after * after - before * before;
    };
    change(excess(vertex), n - k + 1 - regular_valence(false));
    change(0, k + 1 - regular_valence(false));
    for (const Index v : {map_.target(first), map_.target(last)}) change(excess(v), excess(v) + 1);
    if (opening.gain < least) continue;
    if (!best || opening.worth() > best->worth()) best = opening;
  }
  return best;
}

std::optional<FaceRepair::Opening> FaceRepair::best_opening(Index vertex) const {
  std::optional<Opening> best;
  constexpr std::size_t far_too_many = 7;
  if (map_.valence(vertex) < far_too_many || !may_open(vertex)) return best;
  map_.for_each_leaving(vertex, [&](Index first) {
    const std::optional<Opening> opening = opening_from(first, best ? best->gain : 1);
    if (opening && (!best || opening->worth() > best->worth())) best = opening;
  });
  return best;
}

void FaceRepair::open(const Opening& opening) {
  const auto& [gain, squares, first, last] = opening;
  const Index kept = map_.origin(first);
  cut(first, last);
  clusters_.hold.back() = free_vertex;
  // The faces on both sides have become one: each gets its other edge of the two, and what is left
  // between them is the quad.
  add_edge(last, map_.next(first));
  add_edge(first, map_.next(last));
  for (const Index v : {kept, map_.origin(first)}) {
    if (clusters_.hold[v] != free_vertex) continue;
    constexpr float apart = 0.25f;  // of the way to the other ends of its edges
    Vec3 sum = Vec3::Zero();
    map_.for_each_leaving(v, [&](Index h) { sum += clusters_.positions[map_.target(h)]; });
    const Vec3 mean = sum / static_cast<float>(map_.valence(v));
    clusters_.positions[v] += apart * (mean - clusters_.positions[v]);
  }
}

void FaceRepair::open_vertices() {
  for (Index v = 0; v < map_.vertices(); ++v) {  // new ones, too
    while (const std::optional<Opening> opening = best_opening(v)) open(*opening);
  }
}

std::size_t FaceRepair::open_vertices(std::size_t count, const Context& context) {
  constexpr Opening none{.gain = std::numeric_limits<int>::min()};
  const auto opening = [&](Index h, int least) -> std::optional<Opening> {
    if (map_.removed(h) || !may_open(map_.origin(h))) return std::nullopt;
    return opening_from(h, least);
  };
  const auto any = [&](Index h) { return *opening(h, none.gain); };
  return change_best(
      count, none.worth(),
      [&](Index h, const auto& least) {
        const std::optional<Opening> best = opening(h, std::get<0>(least));
        return best ? std::optional(best->worth()) : std::nullopt;
      },
      // Where there is most room.
      [&](Index h) { return -distance(map_.target(h), map_.target(any(h).last)); },
      [&](Index h) { open(any(h)); }, context);
}

std::size_t FaceRepair::close_quads(std::size_t count, const Context& context) {
  return change_best(
      count, std::numeric_limits<int>::min(),
      [&](Index h, int least) { return closing_gain(h, least); },
      [&](Index h) { return distance(map_.origin(h), map_.target(map_.next(h))); },
      [&](Index h) { close_quad(h); }, context);
}

}  // namespace meshgrain
