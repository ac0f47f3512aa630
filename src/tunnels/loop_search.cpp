#include "tunnels/loop_search.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "util/union_find.h"

namespace meshgrain {

LoopSearch::LoopSearch(const Mesh& triangles, const VertexFaces& around)
    : mesh_(triangles),
      around_(around),
      round_of_(triangles.positions.size(), 0),
      distance_(triangles.positions.size()),
      before_(triangles.positions.size()),
      round_of_face_(triangles.faces.size(), 0),
      number_of_face_(triangles.faces.size()) {}

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

/// What lies farther off than all that was reached counts as one face.
constexpr Index farther_off = 0;

Index LoopSearch::number_of(Index face) {
  if (round_of_face_[face] == round_) return number_of_face_[face];
  const bool is_whole =
      std::ranges::all_of(mesh_.faces[face], [&](Index v) { return is_reached(v); });
  round_of_face_[face] = round_;
  return number_of_face_[face] = is_whole ? faces_++ : farther_off;
}

std::vector<LoopSearch::Chord> LoopSearch::chords() {
  struct Side {
    Index end;  // of the edge, the other one
    Index face;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;  // of a vertex
  std::vector<Chord> result;
  faces_ = 1;
  for (const Index v : reached_) {
    sides.clear();
    for (const Index f : around_[v]) {
      for (const Index w : mesh_.faces[f]) {
        if (w > v && is_reached(w)) sides.push_back({w, number_of(f)});
      }
    }
    std::ranges::sort(sides);
    for (std::size_t k = 0, next = 0; k < sides.size(); k = next) {
      const Index w = sides[k].end;
      while (next < sides.size() && sides[next].end == w) ++next;
      if (before_[v] == w || before_[w] == v) continue;
      const double edge = (mesh_.positions[v] - mesh_.positions[w]).norm();
      const Index other = next - k > 1 ? sides[k + 1].face : farther_off;
      result.push_back({distance_[v] + distance_[w] + edge, {v, w}, {sides[k].face, other}});
    }
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

std::vector<Index> LoopSearch::thinned_out(std::span<const Index> places, double distance) {
  std::vector<std::uint8_t> is_covered(mesh_.positions.size(), 0);
  std::vector<Index> some;
  for (const Index v : places) {
    if (is_covered[v] || around_[v].empty()) continue;
    some.push_back(v);
    reach_from(v, distance);
    for (const Index w : reached_) is_covered[w] = 1;
  }
  return some;
}

std::vector<std::vector<Index>> LoopSearch::near(Index vertex, double distance, double longest) {
  reach_from(vertex, distance + longest / 2);
  std::vector<Chord> all = chords();
  // Faces are joined across chords as long as that closes no ring of faces. A chord that is left
  // runs around a ring.
  const auto rings = [&](const auto& take) {
    UnionFind joined(faces_);
    for (const Chord& chord : all) {
      if (!joined.unite(chord.sides[0], chord.sides[1])) take(chord);
    }
  };
  bool are_any = false;
  rings([&](const Chord&) { are_any = true; });
  std::vector<std::vector<Index>> loops;
  if (!are_any) return loops;
  // Those across the longest are joined first.
  std::ranges::sort(all, [](const Chord& a, const Chord& b) {
    return std::tie(a.loop, a.ends) > std::tie(b.loop, b.ends);
  });
  rings([&](const Chord& chord) { loops.push_back(loop_of(chord)); });
  return loops;
}

}  // namespace meshgrain
