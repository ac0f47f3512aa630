#include "coarsen/collapsing_piece.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace meshgrain {
namespace {

/// The normal of a triangle, twice as long as its area.
Vec3 area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a);
}

}  // namespace

void CollapsingPiece::Ring::remove(Index v) {
  const auto end = around.begin() + size;
  std::copy(std::find(around.begin(), end, v) + 1, end, std::find(around.begin(), end, v));
  --size;
}

CollapsingPiece::CollapsingPiece(std::vector<Vec3> positions, std::vector<std::uint8_t> is_free,
                                 std::span<const Triangle> triangles)
    : positions_(std::move(positions)),
      is_free_(std::move(is_free)),
      faces_(positions_.size(), 0),
      rings_(positions_.size()) {
  find_rings(triangles);
  for (const Triangle& t : triangles) {
    if (!is_free_[t[0]] && !is_free_[t[1]] && !is_free_[t[2]]) fixed_.push_back(t);
  }
}

void CollapsingPiece::find_rings(std::span<const Triangle> triangles) {
  // The edges opposite to each vertex.
  std::vector<Index> first(positions_.size() + 1, 0);
  for (const Triangle& t : triangles) {
    for (const Index v : t) ++first[v + 1];
  }
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    faces_[v] = static_cast<std::uint16_t>(
        std::min<Index>(first[v + 1], std::numeric_limits<std::uint16_t>::max()));
    first[v + 1] += first[v];
  }
  std::vector<std::array<Index, 2>> opposite(3 * triangles.size());
  for (std::size_t f = triangles.size(); f-- > 0;) {
    const auto [a, b, c] = triangles[f];
    opposite[--first[a + 1]] = {b, c};
    opposite[--first[b + 1]] = {c, a};
    opposite[--first[c + 1]] = {a, b};
  }
  for (Index v = 0; v < positions_.size(); ++v) {
    if (!is_free_[v]) continue;
    is_free_[v] = follow({opposite.data() + first[v + 1], faces_[v]}, rings_[v]);
    if (!is_free_[v]) rings_[v].size = 0;
  }
}

bool CollapsingPiece::follow(std::span<const std::array<Index, 2>> edges, Ring& ring) {
  if (edges.size() < 3 || edges.size() > most_neighbors) return false;
  Index next = edges[0][0];
  do {
    const auto edge = std::ranges::find(edges, next, [](const auto& e) { return e[0]; });
    if (edge == edges.end() || ring.size == edges.size()) return false;
    ring.around[ring.size++] = next;
    next = (*edge)[1];
  } while (next != edges[0][0]);
  return ring.size == edges.size();
}

double CollapsingPiece::mean_edge() const {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    count += rings_[v].size;
    for (std::size_t k = 0; k < rings_[v].size; ++k) {
      sum += (positions_[rings_[v].around[k]] - positions_[v]).norm();
    }
  }
  return sum / std::max<double>(1, static_cast<double>(count));
}

void CollapsingPiece::collapse_short_edges(const CoarseEdges& edges) {
  longest_ = edges.longest;
  // Little by little, or some vertices would take all of their neighbours, and many of theirs.
  constexpr float growth = 1.4f;
  float shortest = growth * static_cast<float>(mean_edge());
  if (!(shortest > 0)) return;  // no vertex is free
  for (;; shortest *= growth) {
    shortest = std::min(shortest, edges.shortest);
    is_new_.assign(positions_.size(), 1);
    while (sweep(shortest) > 0) continue;
    if (shortest >= edges.shortest) return;
  }
}

std::size_t CollapsingPiece::sweep(float shortest) {
  std::size_t gone = 0;
  for (Index v = 0; v < positions_.size(); ++v) {
    if (!is_new_[v] || rings_[v].size == 0) continue;
    const Ring& ring = rings_[v];
    Index nearest = no_index;
    float least = shortest * shortest;
    for (std::size_t k = 0; k < ring.size; ++k) {
      const Index w = ring.around[k];
      const float length = (positions_[w] - positions_[v]).squaredNorm();
      if (!is_free_[w] || length >= least) continue;
      least = length;
      nearest = w;
    }
    if (nearest != no_index && collapse(v, nearest)) {
      ++gone;
    } else {
      is_new_[v] = 0;
    }
  }
  return gone;
}

bool CollapsingPiece::keeps_topology(Index a, Index b) const {
  const Ring &at_a = rings_[a], &at_b = rings_[b];
  const std::size_t left = at_a.size + at_b.size - std::size_t{4};
  if (left < 3 || left >= most_neighbors) return false;
  // The link condition: they have the two neighbours in common that are across their faces.
  std::size_t common = 0;
  for (std::size_t k = 0; k < at_b.size; ++k) {
    const Index v = at_b.around[k];
    if (at_a.find(v) == at_a.size) continue;
    ++common;
    // Each of them loses a face. Others of it may be in other pieces.
    if (faces_[v] < 4) return false;
  }
  return common == 2;
}

void CollapsingPiece::Star::add(const Vec3& at, const Vec3& p, const Vec3& q) {
  center.set(size, at);
  from.set(size, p);
  to.set(size, q);
  ++size;
}

void CollapsingPiece::Star::fill_row() {
  for (std::size_t k = size; k % lanes != 0; ++k) {
    for (Vectors* const vectors : {&center, &from, &to}) {
      vectors->x[k] = vectors->x[size - 1];
      vectors->y[k] = vectors->y[size - 1];
      vectors->z[k] = vectors->z[size - 1];
    }
  }
}

void CollapsingPiece::Star::find_normals() {
  for_each([&](std::size_t k) {
    const float px = from.x[k] - center.x[k], qx = to.x[k] - center.x[k];
    const float py = from.y[k] - center.y[k], qy = to.y[k] - center.y[k];
    const float pz = from.z[k] - center.z[k], qz = to.z[k] - center.z[k];
    normals.x[k] = py * qz - pz * qy;
    normals.y[k] = pz * qx - px * qz;
    normals.z[k] = px * qy - py * qx;
  });
}

CollapsingPiece::Star CollapsingPiece::star(Index a, Index b) const {
  Star star;
  for (const auto& [v, other] : {std::pair(a, b), std::pair(b, a)}) {
    const Ring& ring = rings_[v];
    for (std::size_t k = 0; k < ring.size; ++k) {
      const Index p = ring.around[k], q = ring.around[ring.after(k)];
      if (p != other && q != other) star.add(positions_[v], positions_[p], positions_[q]);
    }
  }
  star.fill_row();
  star.find_normals();
  return star;
}

/// Where the faces around the edge are touched best, in the sense of least squares, of all places
/// that keep the volume.
Vec3 CollapsingPiece::best_place(Index a, Index b, const Star& star) const {
  const Vec3 middle = 0.5f * (positions_[a] + positions_[b]);
  // Of each triangle: how far its plane is from the middle, and the products of its normal.
  alignas(32) std::array<float, Star::most> height, xx, yy, zz, xy, xz, yz;
  const auto& [nx, ny, nz] = star.normals;
  star.for_each([&](std::size_t k) {
    height[k] = nx[k] * (star.from.x[k] - middle.x()) +
                (ny[k] * (star.from.y[k] - middle.y()) + nz[k] * (star.from.z[k] - middle.z()));
    xx[k] = nx[k] * nx[k], yy[k] = ny[k] * ny[k], zz[k] = nz[k] * nz[k];
    xy[k] = nx[k] * ny[k], xz[k] = nx[k] * nz[k], yz[k] = ny[k] * nz[k];
  });
  std::array<float, 6> products{};
  Vec3 right = Vec3::Zero(), sum = Vec3::Zero();
  float volume = 0;
  const auto add = [&](const std::array<float, 6>& more, const Vec3& normal, float far) {
    for (std::size_t i = 0; i < 6; ++i) products[i] += more[i];
    right += normal * far;
    sum += normal;
    volume += far;
  };
  for (std::size_t k = 0; k < star.size; ++k) {
    add({xx[k], yy[k], zz[k], xy[k], xz[k], yz[k]}, Vec3(nx[k], ny[k], nz[k]), height[k]);
  }
  // The two that go.
  const Ring& ring = rings_[a];
  const std::size_t at = ring.find(b), before = at == 0 ? ring.size - std::size_t{1} : at - 1;
  for (const std::size_t k : {before, at}) {
    const Vec3 &p = positions_[ring.around[k]], &q = positions_[ring.around[ring.after(k)]];
    const Vec3 normal = area_normal(positions_[a], p, q);
    const float x = normal.x(), y = normal.y(), z = normal.z();
    add({x * x, y * y, z * z, x * y, x * z, y * z}, normal, normal.dot(p - middle));
  }
  Eigen::Matrix3f squares;
  squares << products[0], products[3], products[4],  //
      products[3], products[1], products[5],         //
      products[4], products[5], products[2];
  const float trace = squares.trace();
  if (!(trace > 0)) return middle;
  constexpr float pull = 0.01f;  // to the middle, along what is flat
  squares.diagonal().array() += pull * trace;
  Vec3 place = squares.inverse() * right;
  constexpr float bent = 0.25f;  // so much that the sum of the normals says nothing
  const float length = sum.squaredNorm();
  if (length > bent * trace) place += sum * ((volume - sum.dot(place)) / length);
  const bool is_near = place.squaredNorm() <= (positions_[b] - middle).squaredNorm();
  return is_near ? Vec3(middle + place) : middle;
}

bool CollapsingPiece::keeps_shape(const Star& star, const Vec3& place) const {
  constexpr float least_cosine = 0.7f, least_quality = 0.15f, farthest = 0.15f;
  const float far = farthest * longest_, longest2 = longest_ * longest_;
  const auto& [nx, ny, nz] = star.normals;
  const auto square = [](float x, float y, float z) { return x * x + (y * y + z * z); };
  std::uint32_t bad = 0;
  star.for_each([&](std::size_t k) {
    const float px = star.from.x[k] - place.x(), qx = star.to.x[k] - place.x();
    const float py = star.from.y[k] - place.y(), qy = star.to.y[k] - place.y();
    const float pz = star.from.z[k] - place.z(), qz = star.to.z[k] - place.z();
    const float ax = py * qz - pz * qy, ay = pz * qx - px * qz, az = px * qy - py * qx;
    const float before = square(nx[k], ny[k], nz[k]), after = square(ax, ay, az);
    const float cosine = nx[k] * ax + (ny[k] * ay + nz[k] * az);
    const float to_p = square(px, py, pz), to_q = square(qx, qy, qz);
    // An equilateral triangle has the squares of twice its area and of the sum of its sides'
    // squares as 1 to 12.
    const float sides = to_p + to_q +
                        square(star.from.x[k] - star.to.x[k], star.from.y[k] - star.to.y[k],
                               star.from.z[k] - star.to.z[k]);
    const float height = nx[k] * px + (ny[k] * py + nz[k] * pz);
    const bool turns =
        !(cosine > 0) | (cosine * cosine < least_cosine * least_cosine * (before * after));
    const bool is_long = std::max(to_p, to_q) > longest2;
    const bool is_thin = after < least_quality * least_quality / 12 * sides * sides;
    const bool is_off = height * height > far * far * before;
    bad |= static_cast<std::uint32_t>(turns | is_long | is_thin | is_off);
  });
  return bad == 0;
}

bool CollapsingPiece::collapse(Index a, Index b) {
  if (!keeps_topology(a, b)) return false;
  const Star beside = star(a, b);
  const Vec3 place = best_place(a, b, beside);
  if (!keeps_shape(beside, place)) return false;
  positions_[a] = place;
  Ring &at_a = rings_[a], &at_b = rings_[b];
  const std::size_t b_at_a = at_a.find(b), a_at_b = at_b.find(a);
  const Index left = at_a.around[at_a.after(b_at_a)], right = at_b.around[at_b.after(a_at_b)];
  // From the left one around a to the right one, and on around b.
  Ring merged;
  for (std::size_t k = at_a.after(b_at_a); k != b_at_a; k = at_a.after(k)) {
    merged.around[merged.size++] = at_a.around[k];
  }
  for (std::size_t k = at_b.after(at_b.after(a_at_b)); at_b.around[k] != left; k = at_b.after(k)) {
    const Index v = at_b.around[k];
    merged.around[merged.size++] = v;
    if (is_free_[v]) rings_[v].around[rings_[v].find(b)] = a;
  }
  for (const Index v : {left, right}) {
    --faces_[v];
    if (is_free_[v]) rings_[v].remove(b);
  }
  faces_[a] = static_cast<std::uint16_t>(merged.size);
  at_a = merged;
  at_b.size = 0;
  is_new_[a] = 1;
  for (std::size_t k = 0; k < merged.size; ++k) is_new_[merged.around[k]] = 1;
  return true;
}

std::vector<CollapsingPiece::Triangle> CollapsingPiece::triangles() const {
  std::vector<Triangle> result = fixed_;
  for (Index v = 0; v < positions_.size(); ++v) {
    const Ring& ring = rings_[v];
    for (std::size_t k = 0; k < ring.size; ++k) {
      const Index p = ring.around[k], q = ring.around[ring.after(k)];
      // Once, at the first of its free vertices.
      if ((is_free_[p] && p < v) || (is_free_[q] && q < v)) continue;
      result.push_back({v, p, q});
    }
  }
  return result;
}

}  // namespace meshgrain
