#include "tunnels/tunnel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "measure/face_shape.h"
#include "tunnels/loop_length.h"

namespace meshgrain {
namespace {

/// Vertices that a path comes to, by their distance.
using Step = std::pair<double, Index>;
using Steps = std::priority_queue<Step, std::vector<Step>, std::greater<>>;

/// How wide a tunnel is on one side of the loop, step by step.
class Width {
 public:
  /// `usual`: the area of a step in a tunnel that is as wide as the loop.
  Width(double usual, double step) : usual_(usual), step_(step) {}

  void add(double area) { area_ += area; }
  /// Nothing nearer than that comes any more.
  void go_to(double distance) {
    constexpr double wider = 1.4;
    while (!has_mouth_ && distance >= (steps_ + 1) * step_) {
      const double before = steps_ > 0 ? sum_ / steps_ : area_;
      has_mouth_ = area_ > wider * std::min(before, usual_);
      sum_ += area_;
      area_ = 0;
      ++steps_;
    }
  }
  /// Whether the tunnel opens there, or nearer.
  bool has_mouth() const { return has_mouth_; }

 private:
  double usual_, step_;
  int steps_ = 0;  // that are over
  double area_ = 0, sum_ = 0;
  bool has_mouth_ = false;
};

}  // namespace

TunnelSearch::TunnelSearch(const Mesh& triangles, const VertexFaces& around,
                           const SleeveCutter& cutter)
    : mesh_(triangles),
      around_(around),
      cutter_(cutter),
      place_(triangles.positions.size(), no_index),
      round_of_(std::max(triangles.positions.size(), triangles.faces.size()), 0),
      side_of_(round_of_.size()),
      was_reached_(triangles.positions.size(), 0) {
  // A surface with its inside out has the solid on the other side.
  double volume = 0;
  for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
    const auto c = triangles.faces[f];
    const auto from_first = [&](Index v) -> Eigen::Vector3d {
      return (triangles.positions[v] - triangles.positions[0]).cast<double>();
    };
    volume += from_first(c[0]).cross(from_first(c[1])).dot(from_first(c[2]));
  }
  is_inside_out_ = volume < 0;
}

bool TunnelSearch::mark(Index which, Side side) {
  if (std::exchange(round_of_[which], round_) == round_) return false;
  side_of_[which] = side;
  return true;
}

bool TunnelSearch::is_in_loop(Index a, Index b) const {
  if (!is_on_loop(a) || !is_on_loop(b)) return false;
  const auto [first, last] = std::minmax(place_[a], place_[b]);
  return last - first == 1 || last - first + 1 == loop_.size();
}

/// The other face at an edge; no_index if there is none, or more than one.
Index TunnelSearch::across(Index f, Index a, Index b) const {
  Index found = no_index;
  for (const Index g : around_[a]) {
    if (g == f || std::ranges::find(mesh_.faces[g], b) == mesh_.faces[g].end()) continue;
    if (found != no_index) return no_index;
    found = g;
  }
  return found == no_index || cutter_.was_cut_out(found) ? no_index : found;
}

/// Calls body(g) for the faces beside f, but not for those beyond the loop.
template <typename Body>
void TunnelSearch::each_across(Index f, const Body& body) const {
  const auto corners = mesh_.faces[f];
  for (std::size_t k = 0; k < 3; ++k) {
    const Index a = corners[k], b = corners[(k + 1) % 3];
    if (is_in_loop(a, b)) continue;
    if (const Index g = across(f, a, b); g != no_index) body(g);
  }
}

/// The faces to the left and to the right of the loop. Returns false if an edge has not exactly one
/// on either side.
bool TunnelSearch::find_sides() {
  for (Faces& side : sides_) side.clear();
  for (std::size_t k = 0; k < loop_.size(); ++k) {
    const Index a = loop_[k], b = loop_[(k + 1) % loop_.size()];
    for (const Index f : around_[a]) {
      const auto corners = mesh_.faces[f];
      const std::size_t at = corner_of(corners, a);
      if (corners[(at + 1) % 3] == b) sides_[left].push_back(f);
      if (corners[(at + 2) % 3] == b) sides_[right].push_back(f);
    }
    if (sides_[left].size() != k + 1 || sides_[right].size() != k + 1) return false;
  }
  return true;
}

/// Whether a way leads from one side to the other.
bool TunnelSearch::are_sides_connected() {
  ++round_;
  std::array<Faces, 2> queues;
  bool meet = false;
  const auto reach = [&](Index f, Side side) {
    if (mark(f, side)) {
      queues[side].push_back(f);
    } else {
      meet = meet || side_of_[f] != side;
    }
  };
  for (const Side side : both) {
    for (const Index f : sides_[side]) reach(f, side);
  }
  // Both grow by turns: it soon shows that a small piece is all that there is on one side.
  for (std::size_t next = 0; !meet; ++next) {
    for (const Side side : both) {
      if (next == queues[side].size()) return false;
      each_across(queues[side][next], [&](Index g) { reach(g, side); });
    }
  }
  return true;
}

/// Whether the surface looks towards the middle of the loop.
bool TunnelSearch::is_hollow() const {
  Vec3 middle = Vec3::Zero();
  for (const Index v : loop_) middle += mesh_.positions[v] / static_cast<float>(loop_.size());
  float sum = 0;
  for (const Index v : loop_) {
    Vec3 normal = Vec3::Zero();
    for (const Index f : around_[v]) normal += area_vector(mesh_.faces[f], mesh_.positions);
    sum += normal.stableNormalized().dot((middle - mesh_.positions[v]).stableNormalized());
  }
  return (sum > 0) != is_inside_out_;
}

/// Whether there is a way no longer than that from one side to the other.
bool TunnelSearch::has_way_around(double longest) {
  std::array<std::vector<Index>, 2> banks;
  for (const Side side : both) {
    for (const Index v : vertices_of(mesh_, sides_[side])) {
      if (!is_on_loop(v)) banks[side].push_back(v);
    }
  }
  ++round_;
  Steps queue;
  for (const Index v : banks[left]) queue.emplace(0, v);
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (!mark(v, left)) continue;
    if (std::ranges::binary_search(banks[right], v)) return true;
    for (const Index f : around_[v]) {
      if (cutter_.was_cut_out(f)) continue;
      for (const Index w : mesh_.faces[f]) {
        const double there = distance + (mesh_.positions[w] - mesh_.positions[v]).norm();
        if (!is_on_loop(w) && there <= longest) queue.emplace(there, w);
      }
    }
  }
  return false;
}

/// Those with a vertex on the loop, marked with the side that they are on.
TunnelSearch::Faces TunnelSearch::faces_at_loop() {
  ++round_;
  Faces found;
  for (const Side side : both) {
    Faces queue = sides_[side];
    while (!queue.empty()) {
      const Index f = queue.back();
      queue.pop_back();
      if (!mark(f, side)) continue;
      found.push_back(f);
      each_across(f, [&](Index g) {
        if (std::ranges::any_of(mesh_.faces[g], [&](Index v) { return is_on_loop(v); })) {
          queue.push_back(g);
        }
      });
    }
  }
  return found;
}

/// Marks the vertices beside the loop instead of the faces. Returns false if one is on both sides.
bool TunnelSearch::mark_banks(const Faces& at_loop) {
  std::vector<std::pair<Index, Side>> banks;
  for (const Index f : at_loop) {
    for (const Index v : mesh_.faces[f]) {
      if (!is_on_loop(v)) banks.emplace_back(v, side_of_[f]);
    }
  }
  ++round_;
  return std::ranges::all_of(banks, [&](const auto& bank) {
    return mark(bank.first, bank.second) || side_of_[bank.first] == bank.second;
  });
}

/// Those on both sides up to the mouths of a tunnel, or a little beyond; none if these do not show.
TunnelSearch::Faces TunnelSearch::faces_in_tunnel(const Faces& at_loop) {
  constexpr double deepest = 8;        // loops
  constexpr double steps_a_loop = 12;  // how often it is looked how wide the tunnel is
  double edge = 0;
  for (const Index f : at_loop) {
    const auto corners = mesh_.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& next = mesh_.positions[corners[(k + 1) % 3]];
      edge = std::max<double>(edge, (mesh_.positions[corners[k]] - next).norm());
    }
  }
  if (!mark_banks(at_loop)) return {};
  const double step = std::max(length_ / steps_a_loop, edge);
  std::array<Width, 2> widths{Width(step * length_, step), Width(step * length_, step)};
  Steps queue;
  std::vector<Index> reached = loop_;
  for (const Index v : loop_) was_reached_[v] = 1;
  bool meet = false;
  const auto go_on = [&](Index v, double distance) {
    for (const Index f : around_[v]) {
      for (const Index w : mesh_.faces[f]) {
        if (was_reached_[w] || cutter_.is_taken(w)) continue;
        if (!is_on_loop(v) && !mark(w, side_of_[v])) meet = meet || side_of_[w] != side_of_[v];
        if (!is_marked(w)) continue;  // of another fan of faces at a vertex that is not manifold
        queue.emplace(distance + (mesh_.positions[w] - mesh_.positions[v]).norm(), w);
      }
    }
  };
  for (const Index v : loop_) go_on(v, 0);
  Faces found;
  const auto have_mouths = [&] { return widths[left].has_mouth() && widths[right].has_mouth(); };
  while (!queue.empty() && !meet && !have_mouths() && queue.top().first <= deepest * length_) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (was_reached_[v]) continue;
    Width& width = widths[side_of_[v]];
    width.go_to(distance);
    if (width.has_mouth()) continue;
    was_reached_[v] = 1;
    reached.push_back(v);
    for (const Index f : around_[v]) {
      if (std::ranges::any_of(mesh_.faces[f], [&](Index w) { return !was_reached_[w]; })) continue;
      found.push_back(f);
      width.add(area_vector(mesh_.faces[f], mesh_.positions).norm());
    }
    go_on(v, distance);
  }
  for (const Index v : reached) was_reached_[v] = 0;
  if (meet || !have_mouths()) return {};
  return found;
}

std::optional<Sleeve> TunnelSearch::sleeve_around(const std::vector<Index>& loop, Kind kind,
                                                  double longest) {
  if (loop.size() < 3) return std::nullopt;
  if (std::ranges::any_of(loop, [&](Index v) { return cutter_.is_taken(v); })) return std::nullopt;
  loop_ = loop;
  length_ = loop_length(loop, mesh_.positions);
  for (Index k = 0; k < loop.size(); ++k) place_[loop[k]] = k;
  constexpr double longest_rim = 2.5;  // times as long as a loop may be
  std::optional<Sleeve> sleeve;
  const bool is_hollow_one = kind == Kind::hollow;
  // What is near is looked at first: whether the rest stays connected may take long.
  if (find_sides() && is_hollow() == is_hollow_one) {
    const Faces at_loop = faces_at_loop();
    Faces all = is_hollow_one ? faces_in_tunnel(at_loop) : Faces();
    if (!all.empty()) {
      all.insert(all.end(), at_loop.begin(), at_loop.end());
      sleeve = cutter_.sleeve_of(std::move(all), longest_rim * longest);
    }
    if (!sleeve) sleeve = cutter_.sleeve_of(at_loop, longest_rim * longest);
    const bool is_one =
        sleeve && (is_hollow_one || has_way_around(longest)) && are_sides_connected();
    if (!is_one) sleeve.reset();
  }
  for (const Index v : loop) place_[v] = no_index;
  return sleeve;
}

}  // namespace meshgrain
