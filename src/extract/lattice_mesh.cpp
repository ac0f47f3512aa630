#include "extract/lattice_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "field/rosy.h"

namespace meshgrain {

LatticeMesh::LatticeMesh(JumpMap&& shrunk, Clusters&& clusters_of_vertices,
                         std::span<const Index> roots, const Graph& graph,
                         const OrientationField& orientation, const PositionField& position,
                         std::span<const std::uint8_t> keeps_singularities)
    : JumpMap(std::move(shrunk)), clusters(std::move(clusters_of_vertices)) {
  directions_.resize(roots.size());
  lengths_.resize(roots.size());
  reach_.resize(roots.size(), 0);
  for (std::size_t v = 0; v < roots.size(); ++v) {
    const Index root = roots[v];
    directions_[v] =
        transport(orientation.directions[root], graph.normals[root], clusters.normals[v]);
    lengths_[v] = position.edge_length[root];
    if (!keeps_singularities.empty()) keeps_singularities_.push_back(keeps_singularities[root]);
  }
}

LatticePoint LatticeMesh::coordinates(const Vec3& d, Index v) const {
  const Vec3& u = directions_[v];
  const double a = d.dot(u), b = d.dot(clusters.normals[v].cross(u));
  if (posy == 4) return {a, b};
  const double y = b * (2 / std::sqrt(3.0));
  return {a - y / 2, y};
}

LatticePoint LatticeMesh::real_jump(Index h) const {
  const Index i = map.origin(h), j = map.target(h);
  const Vec3 d = clusters.positions[j] - clusters.positions[i];
  const int turn = posy - jump(h).rotation;
  const LatticePoint here = coordinates(d, i), there = coordinates(d, j);
  const auto u = rotate_jump({1, 0}, turn, posy), v = rotate_jump({0, 1}, turn, posy);
  const double scale = 1 / (static_cast<double>(lengths_[i]) + lengths_[j]);
  const double x = here[0] + u[0] * there[0] + v[0] * there[1];
  const double y = here[1] + u[1] * there[0] + v[1] * there[1];
  return {x * scale, y * scale};
}

bool LatticeMesh::is_graded(Index h) const {
  const auto [least, most] = std::minmax(
      {lengths_[map.origin(h)], lengths_[map.target(h)], lengths_[map.target(map.next(h))]});
  constexpr float considerably = 1.001f;
  return most > considerably * least;
}

bool LatticeMesh::keeps_singularity(Index h) const {
  return !keeps_singularities_.empty() &&
         (keeps_singularities_[map.origin(h)] || keeps_singularities_[map.target(h)] ||
          keeps_singularities_[map.target(map.next(h))]);
}

double LatticeMesh::misfit(Index h, const std::array<int, 2>& t) const {
  const LatticePoint real = real_jump(h);
  return metric().squared_length(LatticePoint{t[0] - real[0], t[1] - real[1]});
}

double LatticeMesh::total_angle(Index vertex) const {
  double sum = 0;
  for_each_leaving(vertex, [&](Index h) {
    if (!holes[h]) sum += triangle(h).angle(0);
  });
  return sum;
}

bool LatticeMesh::may_flip(Index h) const {
  const Index t = PolygonMap::twin(h);
  if (map.removed(h) || holes[h] || holes[t] || on_feature(h)) return false;
  const Index c = map.origin(map.prev(h)), d = map.origin(map.prev(t));
  if (c == d || map.adjacent(c, d)) return false;
  // An inner vertex needs three edges, one on the border two.
  const auto can_lose_one = [&](Index v) {
    std::size_t valence = 0;
    bool rim = false;
    for_each_leaving(v, [&](Index g) {
      ++valence;
      rim = rim || holes[g];
    });
    return valence > (rim ? 2u : 3u);
  };
  return can_lose_one(map.origin(h)) && can_lose_one(map.origin(t));
}

Jump LatticeMesh::flipped_jump(Index h) const {
  return composed(jump(map.prev(h)), jump(map.next(PolygonMap::twin(h))), posy);
}

void LatticeMesh::flip(Index h) {
  const Jump across = flipped_jump(h);
  const Index from = map.prev(h), to = map.prev(PolygonMap::twin(h));
  map.remove_edge(h);
  add_edge(from, to, across);
}

void LatticeMesh::add_edge(Index from, Index to, const Jump& jump) {
  const Index added = map.add_edge(from, to);
  holes.resize(map.halfedges(), 0);
  jumps.resize(map.halfedges() / 2);
  lines.resize(map.halfedges() / 2, no_index);
  set_jump(added, jump);
}

float LatticeMesh::reach_with_target(Index h) const {
  const Index a = map.origin(h), b = map.target(h);
  const float step = (clusters.positions[a] - clusters.positions[b]).norm() / lengths_[a];
  return std::max(reach_[a], reach_[b] + step);
}

bool LatticeMesh::may_collapse(Index h) {
  constexpr float farthest = 2;
  if (clusters.on_border[map.target(h)] && !clusters.on_border[map.origin(h)]) return false;
  if (reach_with_target(h) > farthest || !keeps_features(h)) return false;
  return link_.holds(map, holes, h);
}

void LatticeMesh::collapse_edge(Index h) {
  clusters.cover[map.origin(h)] += clusters.cover[map.target(h)];
  reach_[map.origin(h)] = reach_with_target(h);
  collapse(h, [&](Index from, Index to, const Jump& x, const Jump& y) {
    const Vec3 d = (clusters.positions[to] - clusters.positions[from]) / lengths_[from];
    const LatticePoint real = coordinates(d, from);
    const auto error = [&](const Jump& jump) {
      return metric().squared_length(LatticePoint{jump.t[0] - real[0], jump.t[1] - real[1]});
    };
    return error(x) < error(y);
  });
}

void LatticeMesh::add_vertex(Index like, const Vec3& position, bool on_border, Hold held) {
  clusters.positions.push_back(position);
  clusters.normals.push_back(clusters.normals[like]);
  clusters.nodes.push_back(clusters.nodes[like]);
  clusters.cover.push_back(0);
  clusters.on_border.push_back(on_border);
  hold.push_back(held);
  directions_.push_back(directions_[like]);
  lengths_.push_back(lengths_[like]);
  if (!keeps_singularities_.empty()) keeps_singularities_.push_back(keeps_singularities_[like]);
  reach_.push_back(0);
}

void LatticeMesh::split(Index h, const std::array<int, 2>& t) {
  const Index twin = PolygonMap::twin(h);
  const Vec3 &a = clusters.positions[map.origin(h)], &b = clusters.positions[map.target(h)];
  const Jump whole = jump(h);
  const double share = std::sqrt(metric().squared_length(t) / squared_length(h));
  add_vertex(map.origin(h), a + static_cast<float>(share) * (b - a), holes[h] || holes[twin],
             on_feature(h) ? on_line : free_vertex);
  const Index rest = map.split_edge(h);  // from the new vertex to the old target
  holes.push_back(holes[h]);
  holes.push_back(holes[twin]);
  jumps.emplace_back();
  lines.push_back(lines[h / 2]);
  const Jump first{0, t}, back = reversed(first, posy);
  set_jump(h, first);
  set_jump(rest, composed(back, whole, posy));
  // New edges to the apexes on both sides.
  if (!holes[h]) {
    const Index from_apex = map.prev(h);  // to the origin of h
    add_edge(rest, from_apex, composed(back, reversed(jump(from_apex), posy), posy));
  }
  if (!holes[twin]) {
    const Index to_apex = map.next(twin);  // from the origin of h
    add_edge(twin, map.next(to_apex), composed(back, jump(to_apex), posy));
  }
}

void LatticeMesh::insert(Index h, const std::array<int, 2>& t, const Jump& to_apex) {
  const Index a = map.origin(h), b = map.target(h), c = map.target(map.next(h));
  const Jump back = reversed(Jump{0, t}, posy);
  const Jump to_b = composed(back, jump(h), posy);
  add_vertex(a, (clusters.positions[a] + clusters.positions[b] + clusters.positions[c]) / 3, false,
             free_vertex);
  const auto spoke = static_cast<Index>(map.halfedges());  // two a corner, the first to a
  map.add_hub(h);
  holes.resize(map.halfedges(), 0);
  jumps.resize(map.halfedges() / 2);
  lines.resize(map.halfedges() / 2, no_index);
  set_jump(spoke, back);
  set_jump(spoke + 2, to_b);
  set_jump(spoke + 4, to_apex);
}

bool LatticeMesh::shift_spoils_lines(Index vertex, const std::array<int, 2>& t) const {
  bool any = false;
  for_each_leaving(vertex, [&](Index g) {
    const auto own = jump(g).t;
    // Along an axis is the same from both ends.
    any = any || spoils_line(g, {own[0] - t[0], own[1] - t[1]});
  });
  return any;
}

void LatticeMesh::shift(Index vertex, const std::array<int, 2>& t) {
  for_each_leaving(vertex, [&](Index g) {
    Jump moved = jump(g);
    moved.t = {moved.t[0] - t[0], moved.t[1] - t[1]};
    set_jump(g, moved);
  });
}

}  // namespace meshgrain
