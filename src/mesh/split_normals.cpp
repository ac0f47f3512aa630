#include "mesh/split_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "mesh/border.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

using Edges = std::vector<std::array<Index, 2>>;

constexpr double least_degrees = 1;  // normals that differ less are equal
const double cosine = std::cos(least_degrees * std::numbers::pi / 180);

/// Unit normals by corner.
class Shading {
 public:
  Shading(const Mesh& mesh, const CornerNormals& given) : mesh_(mesh), corners_(given.corners) {
    normals_.reserve(given.normals.size());
    for (const Vec3& n : given.normals) {
      const float length = n.stableNorm();
      const bool has_direction = length > 0 && std::isfinite(length);
      normals_.push_back(has_direction ? Vec3(n / length) : Vec3(Vec3::Zero()));
    }
  }

  /// Whether two corners have normals, and these differ.
  bool differ(std::size_t i, std::size_t j) const {
    if (corners_[i] == corners_[j]) return false;
    const Vec3 *p = normal(i), *q = normal(j);
    return p && q && p->dot(*q) < cosine;
  }

  bool has_splits() const {
    std::vector<std::size_t> seen(mesh_.positions.size(), no_corner);
    const auto corners = mesh_.faces.corners();
    for (std::size_t c = 0; c < corners.size(); ++c) {
      if (!normal(c)) continue;
      std::size_t& first = seen[corners[c]];
      if (first == no_corner) first = c;
      if (differ(first, c)) return true;
    }
    return false;
  }

  bool is_split(const InnerEdge& edge) const {
    return std::all_of(edge.ends.begin(), edge.ends.end(), [&](Index v) {
      return differ(corner(edge.left, v), corner(edge.right, v));
    });
  }

 private:
  static constexpr std::size_t no_corner = ~std::size_t{0};

  const Vec3* normal(std::size_t corner) const {
    const Index n = corners_[corner];
    return n < normals_.size() && !normals_[n].isZero(0) ? &normals_[n] : nullptr;
  }

  std::size_t corner(Index face, Index vertex) const {
    const auto corners = mesh_.faces[face];
    const auto at = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    return mesh_.faces.first(face) + static_cast<std::size_t>(at);
  }

  const Mesh& mesh_;
  std::vector<Vec3> normals_;
  const std::vector<Index>& corners_;
};

/// An edge that has an angle or is split.
struct ShadedEdge {
  std::array<Index, 2> ends;
  Index piece;
  double degrees, length;
  bool split;
};

/// Whether the split edges of a piece are just those that are sharper than some angle, as programs
/// shade that are told no edges.
class AngleTest {
 public:
  explicit AngleTest(const Mesh& mesh) : rays_(mesh.positions.size(), 0) {
    for (const auto& ends : rim_edges(mesh)) {
      for (const Index v : ends) ++rays_[v];
    }
  }

  /// Whether angles say as much as the normals of a piece, or more.
  bool tells(std::span<const ShadedEdge> edges) {
    const auto length_of = [&](const auto& wanted) {
      double sum = 0;
      for (const ShadedEdge& edge : edges) sum += wanted(edge) ? edge.length : 0;
      return sum;
    };
    const double split = length_of([](const ShadedEdge& e) { return e.split; });
    const double smooth = length_of([](const ShadedEdge& e) { return !e.split; });
    if (split == 0) return true;
    for (const double share : {0.0, 0.05, 0.1}) {
      const double limit = angle_below(edges, share * split);
      if (difference(edges, limit) > 0.25 * split) continue;
      // A clear case remains: a part whose hard edges are far sharper than its smooth ones.
      const double doubtful = length_of([&](const ShadedEdge& e) {
        return !e.split && e.degrees > limit / 1.5 && e.degrees < limit;
      });
      const bool is_clear = limit >= 20 && doubtful < 0.1 * split && smooth > 0.05 * split;
      if (!is_clear) return true;
    }
    return false;
  }

 private:
  /// The angle of the flattest split edge but for flatter ones of that length in all.
  static double angle_below(std::span<const ShadedEdge> edges, double length) {
    std::vector<std::pair<double, double>> split;
    for (const ShadedEdge& e : edges) {
      if (e.split) split.emplace_back(e.degrees, e.length);
    }
    std::sort(split.begin(), split.end());
    std::size_t at = 0;
    for (; at + 1 < split.size() && split[at].second <= length; ++at) length -= split[at].second;
    return split[at].first;
  }

  /// The length of edges that would be split by an angle but are not, or are but would not be.
  /// Where only one sharp edge ends at a vertex, faces go around it smoothly.
  double difference(std::span<const ShadedEdge> edges, double limit) {
    const auto add_rays = [&](Index count) {
      for (const ShadedEdge& e : edges) {
        if (e.degrees < limit) continue;
        for (const Index v : e.ends) rays_[v] += count;
      }
    };
    add_rays(1);
    double sum = 0;
    for (const ShadedEdge& e : edges) {
      const bool expected = e.degrees >= limit && rays_[e.ends[0]] > 1 && rays_[e.ends[1]] > 1;
      if (expected != e.split) sum += e.length;
    }
    add_rays(~Index{0});  // less one
    return sum;
  }

  std::vector<Index> rays_;  // edges at each vertex that part faces
};

/// The split edges and those with an angle, piece after piece.
std::vector<ShadedEdge> shaded_edges(const Mesh& mesh, const Edges& split, const Context& context) {
  UnionFind sets(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) sets.unite(mesh.faces[f][0], v);
  }
  std::vector<ShadedEdge> edges;
  const auto add = [&](const std::array<Index, 2>& ends, double degrees, bool is_split) {
    const double length = (mesh.positions[ends[0]] - mesh.positions[ends[1]]).norm();
    edges.push_back({ends, sets.find(ends[0]), degrees, length, is_split});
  };
  std::vector<std::uint8_t> has_angle(split.size(), 0);
  for (const SharpEdge& edge : sharp_edges(mesh, least_degrees, context)) {
    const auto at = std::lower_bound(split.begin(), split.end(), edge.ends);
    const bool is_split = at != split.end() && *at == edge.ends;
    if (is_split) has_angle[static_cast<std::size_t>(at - split.begin())] = 1;
    const double angle = std::acos(std::clamp(edge.cosine, -1.0, 1.0));
    add(edge.ends, angle * 180 / std::numbers::pi, is_split);
  }
  for (std::size_t e = 0; e < split.size(); ++e) {
    if (!has_angle[e]) add(split[e], 0, true);
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const ShadedEdge& a, const ShadedEdge& b) { return a.piece < b.piece; });
  return edges;
}

}  // namespace

Edges split_edges(const Mesh& mesh, const CornerNormals& given, const Context& context) {
  if (given.corners.empty()) return {};
  const Shading shading(mesh, given);
  if (!shading.has_splits()) return {};
  const auto is_split = [&](const InnerEdge& edge) { return shading.is_split(edge); };
  Edges split;
  for (const InnerEdge& edge : inner_edges(mesh, is_split, context)) split.push_back(edge.ends);
  if (split.empty()) return {};

  const std::vector<ShadedEdge> edges = shaded_edges(mesh, split, context);
  AngleTest angles(mesh);
  Edges result;
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(),
                                  [&](const ShadedEdge& e) { return e.piece != begin->piece; });
    const std::span<const ShadedEdge> piece(begin, end);
    begin = end;
    if (angles.tells(piece)) continue;
    for (const ShadedEdge& edge : piece) {
      if (edge.split) result.push_back(edge.ends);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace meshgrain
