#include "extract/polygon_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "field/rosy.h"
#include "mesh/sort_by_vertex.h"
#include "util/collect.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

/// Of each corner, the next one of its face.
UninitializedVector<Index> corners_after(const Faces& faces, const Context& context) {
  UninitializedVector<Index> after(faces.corners().size());
  context.for_ranges(faces.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto first = static_cast<Index>(faces.first(f));
      const auto last = static_cast<Index>(first + faces.degree(f) - 1);
      for (Index c = first; c < last; ++c) after[c] = c + 1;
      after[last] = first;
    }
  });
  return after;
}

/// The edges of the faces of a mesh by the vertices where they start, those of each in the order of
/// the faces.
class EdgesByOrigin {
 public:
  struct Edge {
    Index target, corner;
  };

  EdgesByOrigin(const Mesh& mesh, std::span<const Index> after, const Context& context)
      : edges_(after.size()) {
    const auto corners = mesh.faces.corners();
    offsets_ = sort_by_vertex(
        corners.size(), mesh.positions.size(),
        [&](std::size_t c) { return std::array{corners[c]}; },
        [&](std::size_t c, Index place) {
          edges_[place] = {corners[after[c]], static_cast<Index>(c)};
        },
        context);
  }

  std::span<const Edge> operator[](Index v) const {
    return {edges_.data() + offsets_[v], offsets_[v + 1] - offsets_[v]};
  }

  /// The corner where the only edge in this direction starts; no_index if there is none or more.
  Index single(Index from, Index to) const {
    Index found = no_index;
    for (const Edge& edge : (*this)[from]) {
      if (edge.target != to) continue;
      if (found != no_index) return no_index;
      found = edge.corner;
    }
    return found;
  }

 private:
  std::vector<Index> offsets_;
  UninitializedVector<Edge> edges_;
};

}  // namespace

PolygonMap::PolygonMap(std::span<const Vec3> positions, std::span<const Vec3> normals,
                       std::span<const std::array<Index, 2>> edges) {
  const std::size_t n = positions.size();
  origin_.resize(2 * edges.size());
  next_.resize(origin_.size());
  prev_.resize(origin_.size());
  leaving_.assign(n, no_index);

  std::vector<Index> offsets(n + 1, 0);
  for (const auto& [a, b] : edges) {
    ++offsets[a + 1];
    ++offsets[b + 1];
  }
  for (std::size_t v = 0; v < n; ++v) offsets[v + 1] += offsets[v];
  std::vector<Index> leaving(origin_.size());
  {
    std::vector<Index> place(offsets.begin(), offsets.end() - 1);
    for (Index e = 0; e < edges.size(); ++e) {
      for (Index side = 0; side < 2; ++side) {
        const Index h = 2 * e + side;
        origin_[h] = edges[e][side];
        leaving[place[origin_[h]]++] = h;
      }
    }
  }

  std::vector<std::pair<float, Index>> star;
  for (Index v = 0; v < n; ++v) {
    const Vec3& normal = normals[v];
    const Vec3 x = any_tangent(normal), y = normal.cross(x);
    star.clear();
    for (Index k = offsets[v]; k < offsets[v + 1]; ++k) {
      const Vec3 d = positions[target(leaving[k])] - positions[v];
      star.emplace_back(std::atan2(d.dot(y), d.dot(x)), leaving[k]);
    }
    std::sort(star.begin(), star.end());
    // Whoever arrives along an edge leaves along the next one clockwise: the face is on the left.
    for (std::size_t k = 0; k < star.size(); ++k) {
      const Index arriving = twin(star[k].second);
      const Index departing = star[k == 0 ? star.size() - 1 : k - 1].second;
      next_[arriving] = departing;
      prev_[departing] = arriving;
    }
    if (!star.empty()) leaving_[v] = star[0].second;
  }
}

PolygonMap::PolygonMap(const Mesh& mesh, std::vector<Index>& sources, std::vector<Index>& corner_at,
                       const Context& context) {
  const auto in_parallel = [&](std::size_t count, const auto& body) {
    for_indices(count, body, context);
  };
  const UninitializedVector<Index> after = corners_after(mesh.faces, context);
  const EdgesByOrigin edges(mesh, after, context);
  // Of each corner, the one where the same edge starts in the other direction.
  std::vector<Index> opposite(after.size(), no_index);
  in_parallel(mesh.positions.size(), [&](Index v) {
    for (const auto& [target, corner] : edges[v]) {
      if (v > target || edges.single(v, target) != corner) continue;  // from the lower end
      opposite[corner] = edges.single(target, v);
      if (opposite[corner] != no_index) opposite[opposite[corner]] = corner;
    }
  });

  // A pair of halfedges for each edge, in the order of the corners where the even ones start.
  const std::vector<Index> even = indices_where(
      after.size(), [&](Index c) { return c < opposite[c]; }, context);
  UninitializedVector<Index> halfedge_of(after.size());  // that starts at a corner
  corner_at.resize(2 * even.size());
  in_parallel(even.size(), [&](Index e) {
    const Index corner = even[e], other = opposite[corner];
    corner_at[2 * e] = corner;
    corner_at[2 * e + 1] = other;
    halfedge_of[corner] = 2 * e;
    if (other != no_index) halfedge_of[other] = 2 * e + 1;
  });
  next_.resize(corner_at.size());
  prev_.resize(corner_at.size());
  const auto link = [&](Index h, Index g) {
    next_[h] = g;
    prev_[g] = h;
  };
  in_parallel(after.size(), [&](Index c) { link(halfedge_of[c], halfedge_of[after[c]]); });
  // A border halfedge goes on along the border: around its target, past the faces there.
  in_parallel(even.size(), [&](Index e) {
    const Index h = 2 * e + 1;
    if (corner_at[h] != no_index) return;
    Index g = prev_[twin(h)];
    while (corner_at[twin(g)] != no_index) g = prev_[twin(g)];
    link(h, twin(g));
  });

  // Vertices: one for each cycle of halfedges that leave it, in the order of the mesh's.
  origin_.assign(next_.size(), no_index);
  const auto set_origin = [&](Index start, Index vertex) {
    Index h = start;
    do {
      origin_[h] = vertex;
      h = around(h);
    } while (h != start);
  };
  struct Cycle {
    Index start, source;
  };
  const auto find_cycles = [&](std::size_t begin, std::size_t end, std::vector<Cycle>& out) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      for (const auto& edge : edges[v]) {
        const Index start = halfedge_of[edge.corner];
        if (origin_[start] != no_index) continue;
        out.push_back({start, v});
        set_origin(start, v);
      }
    }
  };
  const std::vector<Cycle> cycles = collect<Cycle>(mesh.positions.size(), find_cycles, context);
  leaving_.resize(cycles.size());
  sources.resize(cycles.size());
  in_parallel(cycles.size(), [&](Index id) {
    leaving_[id] = cycles[id].start;
    sources[id] = cycles[id].source;
    if (sources[id] != id) set_origin(leaving_[id], id);
  });
}

std::size_t PolygonMap::valence(Index vertex) const {
  if (leaving(vertex) == no_index) return 0;
  std::size_t count = 0;
  for_each_leaving(vertex, [&](Index) { ++count; });
  return count;
}

Index PolygonMap::halfedge(Index from, Index to) const {
  const Index start = leaving_[from];
  if (start == no_index) return no_index;
  Index h = start;
  do {
    if (target(h) == to) return h;
    h = around(h);
  } while (h != start);
  return no_index;
}

std::size_t PolygonMap::degree(Index h) const {
  std::size_t count = 0;
  for_orbit(h, [&](Index) { ++count; });
  return count;
}

void PolygonMap::orbit(Index h, std::vector<Index>& out) const {
  out.clear();
  for_orbit(h, [&](Index g) { out.push_back(g); });
}

void PolygonMap::remove_edge(Index h) {
  const Index t = twin(h);
  for (const Index side : {h, t}) {
    const Index v = origin_[side];
    if (leaving_[v] == side) {
      const Index other = around(side);
      leaving_[v] = other == side ? no_index : other;
    }
  }
  // At each end, whoever arrived before this edge now leaves along what came after its twin.
  const Index hp = prev_[h], hn = next_[h], tp = prev_[t], tn = next_[t];
  if (tn != h) {
    next_[hp] = tn;
    prev_[tn] = hp;
  }
  if (hn != t) {
    next_[tp] = hn;
    prev_[hn] = tp;
  }
  origin_[h] = origin_[t] = no_index;
}

Index PolygonMap::add_edge(Index a, Index b) {
  const auto h = static_cast<Index>(origin_.size()), t = h + 1;
  const Index ap = prev_[a], bp = prev_[b];
  origin_.push_back(origin_[a]);
  origin_.push_back(origin_[b]);
  // ... ap -> h -> b ... and ... bp -> t -> a ...
  next_.push_back(b);
  next_.push_back(a);
  prev_.push_back(ap);
  prev_.push_back(bp);
  next_[ap] = h;
  prev_[b] = h;
  next_[bp] = t;
  prev_[a] = t;
  return h;
}

void PolygonMap::contract_edge(Index h) {
  const Index t = twin(h), kept = origin_[h], gone = origin_[t];
  Index g = around(t);
  while (g != t) {
    origin_[g] = kept;
    g = around(g);
  }
  for (const Index side : {h, t}) {
    next_[prev_[side]] = next_[side];
    prev_[next_[side]] = prev_[side];
  }
  if (leaving_[kept] == h) leaving_[kept] = next_[t] != h ? next_[t] : next_[h];
  leaving_[gone] = no_index;
  origin_[h] = origin_[t] = no_index;
}

Index PolygonMap::split_edge(Index h) {
  const Index t = twin(h), old = origin_[t];
  const auto fresh = static_cast<Index>(leaving_.size());
  const auto out = static_cast<Index>(origin_.size()), back = out + 1;
  const Index after = next_[h], before = prev_[t];
  origin_.insert(origin_.end(), {fresh, old});
  next_.insert(next_.end(), {after == t ? back : after, t});
  prev_.insert(prev_.end(), {h, before == h ? out : before});
  next_[h] = out;
  prev_[t] = back;
  if (after != t) {
    prev_[after] = out;
    next_[before] = back;
  }
  origin_[t] = fresh;
  leaving_.push_back(out);
  if (leaving_[old] == t) leaving_[old] = back;
  return out;
}

Index PolygonMap::split_vertex(Index a, Index b) {
  const auto fresh = static_cast<Index>(leaving_.size());
  const Index old = origin_[a], ap = prev_[a], bp = prev_[b];
  next_[ap] = b;
  prev_[b] = ap;
  next_[bp] = a;
  prev_[a] = bp;
  leaving_[old] = b;
  leaving_.push_back(a);
  Index h = a;
  do {
    origin_[h] = fresh;
    h = around(h);
  } while (h != a);
  return fresh;
}

PolygonMap::Renumbering PolygonMap::compact() {
  Renumbering rank;
  rank.vertices.assign(leaving_.size(), no_index);
  rank.edges.assign(origin_.size() / 2, no_index);
  Index edges = 0, vertices = 0;
  for (Index e = 0; e < rank.edges.size(); ++e) {
    if (!removed(2 * e)) rank.edges[e] = edges++;
  }
  for (Index v = 0; v < leaving_.size(); ++v) {
    if (leaving_[v] != no_index) rank.vertices[v] = vertices++;
  }
  const auto moved = [&](Index h) { return 2 * rank.edges[h / 2] + h % 2; };
  for (Index e = 0; e < rank.edges.size(); ++e) {
    if (rank.edges[e] == no_index) continue;
    for (Index side = 0; side < 2; ++side) {
      const Index h = 2 * e + side, to = moved(h);
      origin_[to] = rank.vertices[origin_[h]];
      next_[to] = moved(next_[h]);
      prev_[to] = moved(prev_[h]);
    }
  }
  for (Index v = 0; v < leaving_.size(); ++v) {
    if (rank.vertices[v] != no_index) leaving_[rank.vertices[v]] = moved(leaving_[v]);
  }
  for (auto* values : {&origin_, &next_, &prev_}) {
    values->resize(2 * edges);
    values->shrink_to_fit();
  }
  leaving_.resize(vertices);
  rank.vertex_count = vertices;
  return rank;
}

Index PolygonMap::add_hub(Index h) {
  std::vector<Index> rim;
  orbit(h, rim);
  const auto hub = static_cast<Index>(leaving_.size());
  const auto first = static_cast<Index>(origin_.size());
  const auto n = static_cast<Index>(rim.size());
  // Spoke k: first + 2k from the hub to the origin of rim[k], first + 2k + 1 back.
  for (Index k = 0; k < n; ++k) {
    origin_.push_back(hub);
    origin_.push_back(origin_[rim[k]]);
    next_.insert(next_.end(), 2, no_index);
    prev_.insert(prev_.end(), 2, no_index);
  }
  for (Index k = 0; k < n; ++k) {
    const Index out = first + 2 * k, back = first + 2 * ((k + 1) % n) + 1;
    next_[out] = rim[k];
    prev_[rim[k]] = out;
    next_[rim[k]] = back;
    prev_[back] = rim[k];
    next_[back] = out;
    prev_[out] = back;
  }
  leaving_.push_back(first);
  return hub;
}

}  // namespace meshgrain
