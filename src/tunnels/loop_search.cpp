#include "tunnels/loop_search.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "util/edge_of.h"
#include "util/union_find.h"

namespace meshgrain {

LoopSearch::LoopSearch(const Mesh& triangles, const VertexFaces& around)
    : mesh_(triangles),
      around_(around),
      round_of_(triangles.positions.size(), 0),
      distance_(triangles.positions.size()),
      before_(triangles.positions.size()) {}

void LoopSearch::reach_from(Index start, double farthest) {
  ++round_;
  reached_.clear();
  using Step = std::pair<double, Index>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
  const auto reach = [&](Index v, double distance, Index before) {
    if (distance > farthest || (is_reached(v) && distance_[v] <= distance)) return;
    if (!is_reached(v)) reached_.push_back(v);
    round_of_[v] = round_;
    distance_[v] = distance;
    before_[v] = before;
    queue.emplace(distance, v);
  };
  reach(start, 0, start);
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > distance_[v]) continue;
    for (const Index f : around_[v]) {
      for (const Index w : mesh_.faces[f]) {
        if (w == v) continue;
        const double edge = (mesh_.positions[w] - mesh_.positions[v]).norm();
        reach(w, distance + edge, v);
      }
    }
  }
}

std::vector<LoopSearch::Chord> LoopSearch::chords() {
  struct Side {
    std::array<Index, 2> ends;
    Index face;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  constexpr Index farther_off = 0;
  faces_ = 1;
  for (const Index v : reached_) {
    for (const Index f : around_[v]) {
      const auto corners = mesh_.faces[f];
      const auto count = std::ranges::count_if(corners, [&](Index w) { return is_reached(w); });
      const bool is_first = std::ranges::all_of(
          corners, [&](Index w) { return w >= v || !is_reached(w); });  // else it comes again
      if (count < 2 || !is_first) continue;
      const Index face = count == 3 ? faces_++ : farther_off;
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = corners[k], b = corners[(k + 1) % 3];
        if (is_reached(a) && is_reached(b)) sides.push_back({edge_of(a, b), face});
      }
    }
  }
  std::ranges::sort(sides);
  std::vector<Chord> result;
  for (std::size_t k = 0, next = 0; k < sides.size(); k = next) {
    const auto [a, b] = sides[k].ends;
    while (next < sides.size() && sides[next].ends == sides[k].ends) ++next;
    if (before_[a] == b || before_[b] == a) continue;
    const double edge = (mesh_.positions[a] - mesh_.positions[b]).norm();
    const Index other = next - k > 1 ? sides[k + 1].face : farther_off;
    result.push_back({distance_[a] + distance_[b] + edge, {a, b}, {sides[k].face, other}});
  }
  return result;
}

std::vector<Index> LoopSearch::loop_of(const Chord& chord) const {
  const auto way_back = [&](Index v) {
    std::vector<Index> way{v};
    while (before_[v] != v) way.push_back(v = before_[v]);
    return way;
  };
  std::vector<Index> loop = way_back(chord.ends[0]), other = way_back(chord.ends[1]);
  // Both end in the same vertices, of which one is enough.
  while (loop.size() > 1 && other.size() > 1 && loop[loop.size() - 2] == other[other.size() - 2]) {
    loop.pop_back();
    other.pop_back();
  }
  other.pop_back();
  loop.insert(loop.end(), other.rbegin(), other.rend());
  return loop;
}

std::vector<std::vector<Index>> LoopSearch::near(Index vertex, double distance, double longest) {
  reach_from(vertex, distance + longest / 2);
  std::vector<Chord> all = chords();
  std::ranges::sort(all, [](const Chord& a, const Chord& b) {
    return std::tie(a.loop, a.ends) > std::tie(b.loop, b.ends);
  });
  // Faces are joined across the longest chords first, as long as that closes no ring of faces. A
  // chord that is left runs around a ring.
  UnionFind joined(faces_);
  std::vector<std::vector<Index>> loops;
  for (const Chord& chord : all) {
    if (!joined.unite(chord.sides[0], chord.sides[1])) loops.push_back(loop_of(chord));
  }
  return loops;
}

}  // namespace meshgrain
