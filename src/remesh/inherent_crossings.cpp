#include "remesh/inherent_crossings.h"

#include <algorithm>

#include "measure/crossings.h"
#include "mesh/pieces.h"

namespace meshgrain {
namespace {

Eigen::AlignedBox3f meeting(const Mesh& of, const std::array<Index, 2>& pair) {
  return face_box(of, pair[0]).intersection(face_box(of, pair[1]));
}

Eigen::AlignedBox3f widened(const Eigen::AlignedBox3f& box, float by) {
  return {Vec3(box.min().array() - by), Vec3(box.max().array() + by)};
}

constexpr double hardly_apart = 0.05;  // sides

BoxCells crossings_of(const Mesh& surface, double side, const Context& context) {
  constexpr double deep = 0.01;  // sides: rounding makes for less
  const auto margin = static_cast<float>(side);
  std::vector<Eigen::AlignedBox3f> boxes;
  for (const auto& pair : find_crossings(surface, context)) {
    if (penetration(surface, pair[0], pair[1]) < deep * side) continue;
    boxes.push_back(widened(meeting(surface, pair), margin));
  }
  return {boxes, margin};
}

}  // namespace

InherentCrossings::InherentCrossings(const Mesh& surface, const Cuts& cuts, double side,
                                     const Context& context)
    : surface_(surface),
      cuts_(cuts),
      near_(static_cast<float>(hardly_apart * side)),
      crossings_(crossings_of(surface, side, context)) {}

bool InherentCrossings::are_near(const Mesh& mesh, const std::array<Index, 2>& faces) const {
  return crossings_.touches(meeting(mesh, faces));
}

bool InherentCrossings::do_touch(Index v, Index w) {
  if (piece_of_.empty()) find_pieces();
  const auto [a, b] = std::minmax(piece_of_[v], piece_of_[w]);
  if (a == b) return false;
  const auto [known, is_new] = touching_.try_emplace({a, b});
  if (is_new) {
    known->second = come_near(pieces_[a], pieces_[b]) || come_near(pieces_[b], pieces_[a]);
  }
  return known->second;
}

void InherentCrossings::find_pieces() {
  const std::size_t count = surface_.positions.size();
  UnionFind together = pieces_of(surface_);
  for (Index v = 0; v < cuts_.sources.size(); ++v) together.unite(v, cuts_.sources[v]);
  piece_of_.resize(count);
  for (Index v = 0; v < count; ++v) {
    const Index first = together.find(v);  // the lowest
    if (first == v) {
      piece_of_[v] = static_cast<Index>(pieces_.size());
      pieces_.emplace_back();
    }
    piece_of_[v] = piece_of_[first];
    Piece& piece = pieces_[piece_of_[v]];
    piece.vertices.push_back(v);
    piece.box.extend(surface_.positions[v]);
  }
  for (std::size_t f = 0; f < surface_.faces.size(); ++f) {
    const auto face = surface_.faces[f];
    pieces_[piece_of_[face[0]]].triangles.push_back({face[0], face[1], face[2]});
  }
}

/// With a vertex: edges that cross each other alone are not looked for.
bool InherentCrossings::come_near(const Piece& piece, Piece& other) const {
  if (!other.tree) other.tree = std::make_unique<Bvh>(surface_.positions, other.triangles);
  const Eigen::AlignedBox3f box = widened(other.box, near_);
  return std::ranges::any_of(piece.vertices, [&](Index v) {
    const Vec3& p = surface_.positions[v];
    return box.contains(p) &&
           other.tree->closest(p.cast<double>(), double{near_} * near_).triangle != no_index;
  });
}

}  // namespace meshgrain
