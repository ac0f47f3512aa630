#include "extract/pair_odd_faces.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "extract/cheapest_pairs.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

// What a way costs, in irregular vertices.
constexpr double of_face = 0.4;           // each that it crosses becomes two
constexpr double of_turn = 2;             // in one of them
constexpr double of_two_triangles = 1.5;  // that become one quad
constexpr double of_contraction = 1.5;    // see contract_end()
constexpr double of_border = 3;           // which others may have to match
constexpr double of_bare_vertex = 20;     // see needs_edge()

/// Whether an edge is crossed twice.
bool comes_back(const std::vector<Index>& exits) {
  std::vector<Index> edges;
  for (const Index h : exits) edges.push_back(h / 2);
  std::ranges::sort(edges);
  return std::ranges::adjacent_find(edges) != edges.end();
}

class OddFaces {
 public:
  OddFaces(PolygonMap& map, FaceRepair& repair, const Context& context)
      : map_(map), repair_(repair), context_(context) {}

  void run();

 private:
  struct Step {
    double cost;
    Index into;    // the halfedge by which a face was reached
    Index before;  // that of the face from which it was, or no_index
    auto operator<=>(const Step&) const = default;
  };

  /// What searches one after the other remember.
  struct Reached {
    // Of each halfedge: in which search a face was reached by it, and by which one that before.
    std::vector<std::uint32_t> search;
    std::vector<Index> before;
    std::uint32_t searches = 0;
  };

  /// The lowest of the halfedges around a face stands for it.
  Index face_of(Index h) const {
    Index lowest = h;
    for (Index g = map_.next(h); g != h; g = map_.next(g)) lowest = std::min(lowest, g);
    return lowest;
  }
  bool is_odd(Index h) const { return map_.degree(h) % 2 == 1; }
  bool turns(Index entry, Index exit) const { return map_.next(map_.next(entry)) != exit; }

  void cut_even_faces();
  bool needs_edge(Index h) const;
  bool takes_triangle(Index h, Index turned_to) const;
  bool vanishes(Index h) const;
  double crossing_cost(Index entry, Index exit) const;
  template <typename Found>
  void search(Index from, Reached& reached, const Found& found) const;
  std::vector<std::vector<Match>> matches();
  void join(Index from, Index to);
  bool is_broken(const std::vector<Index>& exits) const {
    return std::ranges::any_of(exits, [&](Index h) { return map_.removed(h); });
  }
  std::optional<Index> contract_end(Index end, Index& other);
  bool take_end(Index end, Index turned_to);

  PolygonMap& map_;
  FaceRepair& repair_;
  const Context& context_;
  std::vector<Index> faces_;  // those with an odd number of corners, by some halfedge
  Reached reached_;
  // Of each halfedge, while nothing changes.
  enum Known : std::uint8_t { needs_an_edge = 1, is_vanishing = 2 };
  std::vector<std::uint8_t> known_;
};

/// And finds the others.
void OddFaces::cut_even_faces() {
  const auto count = static_cast<Index>(map_.halfedges());
  for (Index h = 0; h < count; ++h) {
    if (map_.removed(h) || repair_.is_hole(h) || face_of(h) != h) continue;
    if (is_odd(h)) {
      faces_.push_back(h);
    } else {
      repair_.cut_into_quads(h);
    }
  }
}

/// Whether a new vertex on that edge must get one of its edges on the side of h: on the other side
/// is a triangle, in which none can start, or two edges of a line would meet there and nothing part
/// them.
bool OddFaces::needs_edge(Index h) const {
  if (!known_.empty()) return (known_[h] & needs_an_edge) != 0;
  const Index beyond = PolygonMap::twin(h);
  return repair_.is_hole(beyond) || repair_.line(h) != no_index || map_.degree(beyond) == 3;
}

/// Whether a face in which the way turns from one edge to the next, or back, may become one with a
/// triangle beyond the first: what is left then has two vertices at most that need an edge, one
/// opposite to the other.
bool OddFaces::takes_triangle(Index h, Index turned_to) const {
  const Index beyond = PolygonMap::twin(h);
  if (repair_.is_hole(beyond) || repair_.line(h) != no_index || map_.degree(beyond) != 3) {
    return false;
  }
  const Index apex = map_.target(map_.next(beyond));
  for (Index g = map_.next(h); g != h; g = map_.next(g)) {
    if (map_.target(g) == apex) return false;
  }
  const Index at_turn = map_.next(h) == turned_to ? beyond : h;
  return map_.valence(map_.origin(at_turn)) > 3 && !repair_.is_last_rung(at_turn);
}

/// Whether the edge is one that contract_end() takes away, with the triangle beyond it.
bool OddFaces::vanishes(Index h) const {
  if (!known_.empty()) return (known_[h] & is_vanishing) != 0;
  return repair_.may_contract_line(PolygonMap::twin(h));
}

/// Of leaving a face, which was reached by `entry` (no_index: it is the first), over `exit`.
double OddFaces::crossing_cost(Index entry, Index exit) const {
  const Index beyond = PolygonMap::twin(exit);
  const bool to_border = repair_.is_hole(beyond);
  double cost = of_face + (to_border ? of_border : 0);
  if (entry == no_index) {
    if (map_.degree(exit) == 3 && needs_edge(exit)) {
      if (repair_.may_join_triangles(exit)) return of_two_triangles;
      if (repair_.may_contract_line(exit)) return cost + of_contraction;
      cost += of_bare_vertex;
    }
  } else if (vanishes(entry) || vanishes(exit)) {
    // What is left has three other edges, and none can start at the new vertex on one of them.
    const Index other = vanishes(exit) ? entry : exit;
    if (needs_edge(other)) cost += repair_.may_remove(other) ? of_two_triangles : of_bare_vertex;
  } else if (turns(entry, exit)) {
    cost += of_turn;
    const bool both = needs_edge(entry) && needs_edge(exit);
    if (both && !takes_triangle(entry, exit) && !takes_triangle(exit, entry)) {
      cost += of_bare_vertex;
    }
  }
  if (!to_border && map_.degree(beyond) == 3 && repair_.line(exit) != no_index) {
    cost += vanishes(exit) ? of_contraction : of_bare_vertex;
  }
  return cost;
}

/// Visits halfedges by which faces can be reached from one, in the order of what the way costs
/// (Dijkstra). Calls found(step) where the face is odd or outside, until it returns true.
template <typename Found>
void OddFaces::search(Index from, Reached& reached, const Found& found) const {
  reached.search.resize(map_.halfedges(), 0);
  reached.before.resize(map_.halfedges());
  const std::uint32_t now = ++reached.searches;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> open;
  const auto leave = [&](double cost, Index entry, Index exit) {
    const Index into = PolygonMap::twin(exit);
    if (reached.search[into] == now) return;
    open.push({cost + crossing_cost(entry, exit), into, entry});
  };
  std::vector<Index> around;
  map_.orbit(from, around);
  for (const Index exit : around) leave(0, no_index, exit);
  while (!open.empty()) {
    const Step step = open.top();
    open.pop();
    if (std::exchange(reached.search[step.into], now) == now) continue;
    reached.before[step.into] = step.before;
    if (repair_.is_hole(step.into) || is_odd(step.into)) {
      if (found(step)) return;
      continue;
    }
    for (Index exit = map_.next(step.into); exit != step.into; exit = map_.next(exit)) {
      leave(step.cost, step.into, exit);
    }
  }
}

/// Of each odd face, the others that are near, or the border.
std::vector<std::vector<Match>> OddFaces::matches() {
  constexpr std::size_t enough = 16, grain = 2;
  // The searches overlap, and nothing changes between them.
  std::vector<std::uint8_t> known(map_.halfedges(), 0);
  const auto find_out = [&](Index h) {
    if (map_.removed(h)) return;
    known[h] = static_cast<std::uint8_t>((needs_edge(h) ? needs_an_edge : 0) |
                                         (vanishes(h) ? is_vanishing : 0));
  };
  for_indices(known.size(), find_out, context_);
  known_ = std::move(known);
  std::vector<std::vector<Match>> result(faces_.size());
  std::vector<Index> number(map_.halfedges(), no_index);
  for (Index i = 0; i < faces_.size(); ++i) number[face_of(faces_[i])] = i;
  const auto look = [&](Index i, Reached& reached) {
    search(faces_[i], reached, [&](const Step& step) {
      const bool outside = repair_.is_hole(step.into);
      const Index with = outside ? Match::nobody : number[face_of(step.into)];
      if (with != i && std::ranges::find(result[i], with, &Match::with) == result[i].end()) {
        result[i].push_back({step.cost, with});
      }
      return outside || result[i].size() == enough;
    });
  };
  tbb::enumerable_thread_specific<Reached> reached;  // as large as the map
  context_.for_ranges(faces_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) look(i, reached.local());
  });
  known_.clear();
  return result;
}

/// `to`: a halfedge of the other face, or Match::nobody for the border.
void OddFaces::join(Index from, Index to) {
  const bool to_border = to == Match::nobody;
  std::vector<Index> exits;  // from the last one on
  search(from, reached_, [&](const Step& step) {
    const bool outside = repair_.is_hole(step.into);
    if (outside != to_border || (!outside && face_of(step.into) != face_of(to))) return false;
    for (Index entry = step.into; entry != no_index; entry = reached_.before[entry]) {
      exits.push_back(PolygonMap::twin(entry));
    }
    return true;
  });
  // A way that goes around something may come back over an edge, which has to stay then.
  if (!comes_back(exits)) {
    // Where the two lie side by side and the way goes around, it may lose an edge with an end.
    if (!exits.empty()) {
      if (const auto rest = contract_end(exits.back(), to)) {
        exits.pop_back();
        if (is_broken(exits)) return join(*rest, to);
        from = *rest;
      }
    }
    if (!exits.empty() && !to_border) {
      if (const auto rest = contract_end(PolygonMap::twin(exits[0]), from)) {
        exits.erase(exits.begin());
        if (is_broken(exits)) return join(from, *rest);
      }
    }
    if (exits.size() == 1 && !to_border && repair_.may_join_triangles(exits[0])) {
      map_.remove_edge(exits[0]);
      return;
    }
    if (exits.size() > 1 && take_end(PolygonMap::twin(exits.back()), exits[exits.size() - 2])) {
      exits.pop_back();
    }
    if (exits.size() > 1 && !to_border && take_end(exits[0], PolygonMap::twin(exits[1]))) {
      exits.erase(exits.begin());
    }
  }
  for (const Index exit : exits) repair_.split_edge(exit);
  for (const Index exit : exits) {
    for (const Index side : {exit, PolygonMap::twin(exit)}) {
      if (!repair_.is_hole(side)) repair_.cut_into_quads(side);
    }
  }
}

/// Where a way starts in a triangle, or ends there, and crosses a line at once: the triangle's edge
/// there vanishes, and the triangle with it. Returns a halfedge of the face beyond, which is odd
/// instead; `other` stands for the one at the other end of the way.
std::optional<Index> OddFaces::contract_end(Index end, Index& other) {
  if (!repair_.may_contract_line(end)) return std::nullopt;
  const Index other_side = PolygonMap::twin(end), beyond = map_.next(other_side);
  const bool is_both = map_.degree(other_side) == 3;
  // Of the other two edges of a triangle one vanishes: what stood for the face beyond may, too.
  std::vector<std::array<Index, 2>> others;
  for (const Index side : {end, other_side}) {
    if (map_.degree(side) == 3) others.push_back({map_.next(side), map_.prev(side)});
  }
  repair_.contract_line(end);
  for (const auto& [a, b] : others) {
    const Index gone = map_.removed(a) ? a : b, left = gone == a ? b : a;
    std::ranges::replace(faces_, PolygonMap::twin(gone), left);
    if (other == PolygonMap::twin(gone)) other = left;
  }
  if (!is_both && !is_odd(beyond)) repair_.cut_into_quads(beyond);
  return beyond;
}

/// Where it turns beside a triangle at its end, and the new vertices on both sides of the turn
/// would need an edge there: the two become one face.
bool OddFaces::take_end(Index end, Index turned_to) {
  if (!turns(end, turned_to) || !needs_edge(end) || !needs_edge(turned_to)) return false;
  if (!takes_triangle(end, turned_to)) return false;
  map_.remove_edge(end);
  return true;
}

void OddFaces::run() {
  cut_even_faces();
  while (!faces_.empty()) {
    const std::vector<Index> partner = cheapest_pairs(matches());
    for (Index i = 0; i < faces_.size(); ++i) {
      const Index j = partner[i];
      if (j == Match::nobody) {
        join(faces_[i], j);
      } else if (j != no_index && i < j) {
        join(faces_[i], faces_[j]);
      }
    }
    std::vector<Index> left;
    for (Index i = 0; i < faces_.size(); ++i) {
      if (partner[i] == no_index) left.push_back(faces_[i]);
    }
    if (left.size() == faces_.size()) return;
    faces_ = std::move(left);
  }
}

}  // namespace

void pair_odd_faces(PolygonMap& map, FaceRepair& repair, const Context& context) {
  OddFaces(map, repair, context).run();
}

}  // namespace meshgrain
