#include "extract/polygon_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "field/rosy.h"

namespace meshgrain {

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

std::size_t PolygonMap::valence(Index vertex) const {
  const Index start = leaving_[vertex];
  if (start == no_index) return 0;
  std::size_t count = 0;
  Index h = start;
  do {
    ++count;
    h = around(h);
  } while (h != start);
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
