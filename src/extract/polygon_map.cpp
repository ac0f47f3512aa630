#include "extract/polygon_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "field/rosy.h"

namespace meshgrain {
namespace {

/// The edges of the faces of a mesh by the vertices where they start, those of each in the order of
/// the faces.
class EdgesByOrigin {
 public:
  struct Edge {
    Index target, corner;
  };

  explicit EdgesByOrigin(const Mesh& mesh) : offsets_(mesh.positions.size() + 1, 0) {
    const auto corners = mesh.faces.corners();
    edges_.resize(corners.size());
    for (const Index v : corners) ++offsets_[v];
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    for (std::size_t f = mesh.faces.size(); f-- > 0;) {
      const auto face = mesh.faces[f];
      for (std::size_t k = face.size(); k-- > 0;) {
        edges_[--offsets_[face[k]]] = {face[k + 1 < face.size() ? k + 1 : 0],
                                       static_cast<Index>(mesh.faces.first(f) + k)};
      }
    }
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
  std::vector<Edge> edges_;
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
  const Faces& faces = mesh.faces;
  const auto corners = faces.corners();
  const EdgesByOrigin edges(mesh);
  // Of each corner, the one where the same edge starts in the other direction.
  std::vector<Index> opposite(corners.size(), no_index);
  context.for_ranges(mesh.positions.size(), 2048, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      for (const auto& [target, corner] : edges[v]) {
        if (v > target || edges.single(v, target) != corner) continue;  // from the lower end
        opposite[corner] = edges.single(target, v);
        if (opposite[corner] != no_index) opposite[opposite[corner]] = corner;
      }
    }
  });
  std::vector<Index> halfedge_of(corners.size(), no_index);  // of the edge that starts at a corner
  const auto add_pair = [&] {
    const auto h = static_cast<Index>(next_.size());
    next_.insert(next_.end(), 2, no_index);
    prev_.insert(prev_.end(), 2, no_index);
    return h;
  };
  for (Index f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < faces.degree(f); ++k) {
      const std::size_t corner = faces.first(f) + k;
      if (halfedge_of[corner] != no_index) continue;
      const Index h = add_pair();
      halfedge_of[corner] = h;
      if (opposite[corner] != no_index) halfedge_of[opposite[corner]] = h + 1;
    }
  }

  corner_at.assign(next_.size(), no_index);
  for (Index f = 0; f < faces.size(); ++f) {
    const std::size_t first = faces.first(f), n = faces.degree(f);
    for (std::size_t k = 0; k < n; ++k) {
      const Index h = halfedge_of[first + k], g = halfedge_of[first + (k + 1) % n];
      next_[h] = g;
      prev_[g] = h;
      corner_at[h] = static_cast<Index>(first + k);
    }
  }

  // A border halfedge goes on along the border: around its target, past the faces there.
  for (Index h = 0; h < next_.size(); ++h) {
    if (corner_at[h] != no_index) continue;
    Index g = prev_[twin(h)];
    while (corner_at[twin(g)] != no_index) g = prev_[twin(g)];
    next_[h] = twin(g);
    prev_[twin(g)] = h;
  }

  // Vertices: one for each cycle of halfedges that leave it, in the order of the mesh's.
  origin_.assign(next_.size(), no_index);
  sources.clear();
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    for (const auto& edge : edges[v]) {
      const Index start = halfedge_of[edge.corner];
      if (origin_[start] != no_index) continue;
      const auto id = static_cast<Index>(leaving_.size());
      leaving_.push_back(start);
      sources.push_back(v);
      Index h = start;
      do {
        origin_[h] = id;
        h = around(h);
      } while (h != start);
    }
  }
}

std::size_t PolygonMap::valence(Index vertex) const {
  if (leaving(vertex) == no_index) return 0;
  std::size_t count = 0;
  for_each_leaving(vertex, [&](Index) { ++count; });
  return count;
}

bool PolygonMap::adjacent(Index a, Index b) const {
  const Index start = leaving_[a];
  if (start == no_index) return false;
  Index h = start;
  do {
    if (target(h) == b) return true;
    h = around(h);
  } while (h != start);
  return false;
}

std::size_t PolygonMap::degree(Index h) const {
  std::size_t count = 0;
  Index g = h;
  do {
    ++count;
    g = next_[g];
  } while (g != h);
  return count;
}

void PolygonMap::orbit(Index h, std::vector<Index>& out) const {
  out.clear();
  Index g = h;
  do {
    out.push_back(g);
    g = next_[g];
  } while (g != h);
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
