#include "mesh/split_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/border.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

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

  /// Whether all corners of a face have the same normal.
  bool is_even(std::size_t f) const {
    const std::size_t first = mesh_.faces.first(f);
    for (std::size_t k = 0; k < mesh_.faces.degree(f); ++k) {
      if (!normal(first + k) || differ(first, first + k)) return false;
    }
    return true;
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

/// What tells flat shading, of a piece. Turns are angles times lengths.
struct Piece {
  std::size_t faces = 0, even_faces = 0;
  double turn = 0, split_turn = 0, split_length = 0, split_length_with_angle = 0;

  bool is_flat() const {
    constexpr double nearly = 0.95, most = 0.5;
    return static_cast<double>(even_faces) >= nearly * static_cast<double>(faces) &&
           split_length_with_angle >= nearly * split_length && split_turn >= most * turn;
  }
};

}  // namespace

std::vector<std::array<Index, 2>> split_edges(const Mesh& mesh, const CornerNormals& given,
                                              const Context& context) {
  if (given.corners.empty()) return {};
  const Shading shading(mesh, given);
  if (!shading.has_splits()) return {};
  const auto is_split = [&](const InnerEdge& edge) { return shading.is_split(edge); };
  std::vector<std::array<Index, 2>> edges;
  for (const InnerEdge& edge : inner_edges(mesh, is_split, context)) edges.push_back(edge.ends);
  if (edges.empty()) return {};

  UnionFind sets(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) sets.unite(mesh.faces[f][0], v);
  }
  std::vector<Piece> pieces(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Piece& piece = pieces[sets.find(mesh.faces[f][0])];
    ++piece.faces;
    piece.even_faces += shading.is_even(f);
  }
  const auto length = [&](const std::array<Index, 2>& ends) {
    return static_cast<double>((mesh.positions[ends[0]] - mesh.positions[ends[1]]).norm());
  };
  for (const auto& ends : edges) pieces[sets.find(ends[0])].split_length += length(ends);
  for (const SharpEdge& edge : sharp_edges(mesh, least_degrees, context)) {
    Piece& piece = pieces[sets.find(edge.ends[0])];
    const double turn = std::acos(std::clamp(edge.cosine, -1.0, 1.0)) * length(edge.ends);
    piece.turn += turn;
    if (!std::binary_search(edges.begin(), edges.end(), edge.ends)) continue;
    piece.split_turn += turn;
    piece.split_length_with_angle += length(edge.ends);
  }
  std::erase_if(edges, [&](const auto& ends) { return pieces[sets.find(ends[0])].is_flat(); });
  return edges;
}

}  // namespace meshgrain
