#include "border/border_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "border/split_polygon.h"
#include "mesh/tangent_angle.h"
#include "util/sort_unique.h"

namespace meshgrain {
namespace {

using std::numbers::pi;

constexpr double straight = 0.8 * pi;  // an angle of a face on the border, or more
constexpr double reflex_cost = 20;     // of an angle; one that stays straight costs more

}  // namespace

/// Whether a face has a vertex of the border that it alone is at, and a straight angle there.
bool BorderFaces::is_straight(Index h) const {
  const Index v = map_.origin(h);
  if (!mesh_.clusters.on_border[v] || mesh_.clusters.hold[v] != at_corner) return false;
  if (map_.valence(v) != 2) return false;
  const auto& p = mesh_.clusters.positions;
  return tangent_angle(p[v], p[map_.target(h)], p[map_.origin(map_.prev(h))],
                       mesh_.clusters.normals[v]) > straight;
}

bool BorderFaces::needs_split(const std::vector<Index>& orbit) const {
  const std::size_t most = kind_ == Kind::triangles ? 3 : 5;
  return orbit.size() > most || std::ranges::any_of(orbit, [&](Index h) { return is_straight(h); });
}

void BorderFaces::mend() {
  // Added halfedges lie at the end; a face that has been split needs nothing more.
  std::vector<Index> orbit;
  const auto count = static_cast<Index>(map_.halfedges());
  for (Index h = 0; h < count; ++h) {
    if (map_.removed(h) || mesh_.holes[h]) continue;
    map_.orbit(h, orbit);
    if (!needs_split(orbit)) continue;
    Index face = h;
    for (Index wider = face; wider != no_index; wider = open(face)) face = wider;
    split(face);
  }
}

/// Where a face has nothing but straight angles beside one edge, takes that edge away. Returns a
/// halfedge of the face that this makes, or no_index.
Index BorderFaces::open(Index h) {
  std::vector<Index> orbit;
  map_.orbit(h, orbit);
  Index base = no_index;
  std::size_t others = 0;
  for (const Index g : orbit) {
    if (is_straight(g)) continue;
    ++others;
    if (!is_straight(map_.next(g))) base = g;
  }
  if (others != 2 || base == no_index) return no_index;
  const Index beyond = PolygonMap::twin(base);
  if (mesh_.holes[beyond] || mesh_.lines[base / 2] != no_index) return no_index;
  std::vector<Index> corners;
  for (Index g = map_.next(base); g != base; g = map_.next(g)) corners.push_back(map_.origin(g));
  for (Index g = map_.next(beyond); g != beyond; g = map_.next(g)) {
    corners.push_back(map_.origin(g));
  }
  const std::size_t all = corners.size();
  sort_unique(corners);
  if (corners.size() != all) return no_index;
  const Index kept = map_.next(base);
  map_.remove_edge(base);
  return kept;
}

void BorderFaces::split(Index h) {
  std::vector<Index> orbit;
  map_.orbit(h, orbit);
  if (!needs_split(orbit)) return;
  constexpr std::size_t most_at_once = 40;
  const std::size_t count = orbit.size();
  if (count > most_at_once) {
    cut_in_two(orbit);
    return;
  }
  const auto found = best_parts(orbit);
  if (found.empty()) {
    if (count > (kind_ == Kind::triangles ? 3u : 5u)) add_hub(orbit);
    return;
  }
  std::size_t next = 0;
  add_chords(orbit, found, next, orbit.back());
}

std::vector<std::vector<std::size_t>> BorderFaces::best_parts(
    const std::vector<Index>& orbit) const {
  constexpr std::size_t few = 14;
  PolygonParts parts;
  const bool pentagons = kind_ == Kind::quads && orbit.size() <= few;
  parts.most_corners = kind_ == Kind::triangles ? 3 : pentagons ? 5 : 4;
  parts.cost = [&](std::span<const std::size_t> part) { return part_cost(orbit, part); };
  parts.may_join = [&](std::size_t i, std::size_t j) {
    return !map_.adjacent(map_.origin(orbit[i]), map_.origin(orbit[j]));
  };
  return split_polygon(orbit.size(), parts);
}

void BorderFaces::find_near() {
  const std::vector<std::uint8_t>& on_border = mesh_.clusters.on_border;
  near_ = on_border;
  std::vector<Index> orbit;
  for (Index h = 0; h < map_.halfedges(); ++h) {
    if (map_.removed(h) || mesh_.holes[h] || !on_border[map_.origin(h)]) continue;
    map_.orbit(h, orbit);
    for (const Index g : orbit) near_[map_.origin(g)] = 1;
  }
}

bool BorderFaces::is_near(const std::vector<Index>& orbit) const {
  return std::ranges::any_of(orbit, [&](Index h) { return near_[map_.origin(h)] != 0; });
}

bool BorderFaces::improve() {
  constexpr int sweeps = 6;
  find_near();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    bool any = false;
    for (Index h = 0; h < map_.halfedges(); h += 2) {
      if (!map_.removed(h) && divide_anew(h)) any = true;
    }
    if (!any) return sweep > 0;
  }
  return true;
}

/// Takes an edge away and divides what lies on both sides of it, if that is better by far.
bool BorderFaces::divide_anew(Index h) {
  const double by_far = kind_ == Kind::only_quads ? 1.0 : 0.4;
  constexpr std::size_t most_corners = 8;
  const Index t = PolygonMap::twin(h);
  if (mesh_.holes[h] || mesh_.holes[t] || mesh_.lines[h / 2] != no_index) return false;
  std::vector<Index> left, right;
  map_.orbit(h, left);
  map_.orbit(t, right);
  if (left.size() + right.size() > most_corners + 2) return false;
  if (!is_near(left) && !is_near(right)) return false;
  const auto whole = [&](const std::vector<Index>& orbit) {
    std::vector<std::size_t> all(orbit.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return part_cost(orbit, all);
  };
  const double before = whole(left) + whole(right);
  if (before < by_far || !std::isfinite(before)) return false;
  std::vector<Index> both(left.begin() + 1, left.end());
  both.insert(both.end(), right.begin() + 1, right.end());
  std::vector<Index> corners;
  for (const Index g : both) corners.push_back(map_.origin(g));
  sort_unique(corners);
  if (corners.size() != both.size()) return false;
  const auto parts = best_parts(both);
  double after = parts.empty() ? std::numeric_limits<double>::infinity() : 0;
  for (const auto& part : parts) after += part_cost(both, part);
  if (std::min(before, after) > reflex_cost && divide_around_hub(h, both)) return true;
  if (!(after < before - by_far)) return false;
  // No vertex inside may be left with two edges.
  for (const Index end : {map_.origin(h), map_.origin(t)}) {
    std::size_t valence = map_.valence(end) - 1;
    for (const auto& part : parts) {
      for (const std::size_t k : part) valence += map_.origin(both[k]) == end;
    }
    --valence;  // one part is there without a chord
    if (!mesh_.clusters.on_border[end] && valence < 3) return false;
  }
  map_.remove_edge(h);
  std::size_t next = 0;
  add_chords(both, parts, next, both.back());
  return true;
}

/// Of two quads at a corner of the border, of which all vertices but one are held: whatever quads
/// they become, one has a straight angle. Three around a new vertex have none.
bool BorderFaces::divide_around_hub(Index h, const std::vector<Index>& both) {
  if (kind_ != Kind::only_quads || both.size() != 6) return false;
  std::array<bool, 2> has_straight{false, false};  // of the even vertices, and the others
  for (std::size_t k = 0; k < 6; ++k) {
    if (is_straight(both[k])) has_straight[k % 2] = true;
  }
  if (has_straight[0] == has_straight[1]) return false;
  map_.remove_edge(h);
  add_hub(both);
  for (std::size_t k = has_straight[0] ? 1 : 0; k < 6; k += 2) map_.remove_edge(map_.prev(both[k]));
  return true;
}

/// From the middle of the longest run of vertices that only this face has.
void BorderFaces::cut_in_two(const std::vector<Index>& orbit) {
  const std::size_t n = orbit.size();
  const auto is_own = [&](std::size_t k) { return map_.valence(map_.origin(orbit[k % n])) == 2; };
  std::size_t begin = 0, length = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (is_own(k + n - 1) && k > 0) continue;
    std::size_t run = 0;
    while (run < n && is_own(k + run)) ++run;
    if (run > length) {
      length = run;
      begin = k;
    }
  }
  const std::size_t from = (begin + length / 2) % n;
  std::size_t best = n;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t gap = (k + n - from) % n;
    if (gap < 2 || gap + 2 > n || (length + 2 < n && is_own(k))) continue;
    const Index a = map_.origin(orbit[from]), b = map_.origin(orbit[k]);
    if (map_.adjacent(a, b)) continue;
    const float d = (mesh_.clusters.positions[a] - mesh_.clusters.positions[b]).norm();
    if (d >= least) continue;
    least = d;
    best = k;
  }
  if (best == n) {
    add_hub(orbit);
    return;
  }
  const Index added = add_edge(orbit[from], orbit[best]);
  split(added);
  split(PolygonMap::twin(added));
}

/// How far the angles of a part are from those of a regular polygon. Vertices of the border will
/// not move to make a straight one better.
double BorderFaces::part_cost(const std::vector<Index>& orbit,
                              std::span<const std::size_t> part) const {
  const auto& positions = mesh_.clusters.positions;
  const std::size_t n = part.size();
  const auto vertex = [&](std::size_t k) { return map_.origin(orbit[part[k % n]]); };
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 0; k < n; ++k) normal += mesh_.clusters.normals[vertex(k)];
  normal.normalize();
  const double regular = pi * static_cast<double>(n - 2) / static_cast<double>(n);
  if (kind_ == Kind::only_quads && n != 4) return std::numeric_limits<double>::infinity();
  double cost = kind_ == Kind::quads && n != 4 ? 0.5 : 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double a = tangent_angle(positions[vertex(k)], positions[vertex(k + 1)],
                                   positions[vertex(k + n - 1)], normal);
    cost += (a - regular) * (a - regular);
    if (a > 1.1 * pi) cost += reflex_cost;
    if (a <= straight || !mesh_.clusters.on_border[vertex(k)]) continue;
    // Between two edges of the border, or nearly along it.
    const bool between = mesh_.holes[PolygonMap::twin(orbit[part[k]])] &&
                         (part[k] + 1) % orbit.size() == part[(k + 1) % n] &&
                         mesh_.holes[PolygonMap::twin(orbit[part[(k + n - 1) % n]])] &&
                         (part[(k + n - 1) % n] + 1) % orbit.size() == part[k];
    cost += between ? 100 : 5;
  }
  return cost;
}

/// `parts` as split_polygon() has them; `last`: the halfedge in the face at its last corner.
void BorderFaces::add_chords(const std::vector<Index>& orbit,
                             const std::vector<std::vector<std::size_t>>& parts, std::size_t& next,
                             Index last) {
  const std::vector<std::size_t>& part = parts[next++];
  for (std::size_t k = 0; k + 1 < part.size(); ++k) {
    if (part[k + 1] == part[k] + 1) continue;
    const Index end = k + 2 == part.size() ? last : orbit[part[k + 1]];
    const Index chord = add_edge(orbit[part[k]], end);
    add_chords(orbit, parts, next, PolygonMap::twin(chord));
  }
}

Index BorderFaces::add_edge(Index a, Index b) {
  const Index added = map_.add_edge(a, b);
  mesh_.holes.resize(map_.halfedges(), 0);
  mesh_.lines.resize(map_.halfedges() / 2, no_index);
  return added;
}

void BorderFaces::add_hub(const std::vector<Index>& orbit) {
  std::vector<Index> rim;
  for (const Index g : orbit) rim.push_back(map_.origin(g));
  mesh_.clusters.append_mean(rim);
  map_.add_hub(orbit[0]);
  mesh_.holes.resize(map_.halfedges(), 0);
  mesh_.lines.resize(map_.halfedges() / 2, no_index);
}

}  // namespace meshgrain
