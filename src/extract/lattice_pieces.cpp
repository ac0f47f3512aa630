#include "extract/lattice_pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meshgrain {
namespace {

/// A full turn, unless the vertex is the apex of one of its triangles.
double full_angle(Index v, std::span<const LatticePiece> pieces) {
  for (const LatticePiece& piece : pieces) {
    if (!piece.lattice.is_cone()) continue;
    for (int k = 0; k < 3; ++k) {
      if (piece.corners[k] == v && piece.lattice.sum(k).is_zero()) {
        return piece.lattice.apex_angle();
      }
    }
  }
  return 2 * std::numbers::pi;
}

}  // namespace

double flaws(std::span<const LatticePiece> pieces, double limit) {
  double sum = 0;
  for (const LatticePiece& piece : pieces) {
    sum += piece.lattice.flaw();
    if (sum > limit) break;
  }
  return sum;
}

std::array<LatticePiece, 2> LatticePieces::flipped(Index h) const {
  const int posy = lattice_.posy;
  const Index t = PolygonMap::twin(h);
  const Index a = map_.origin(h), b = map_.target(h);
  const Index c = map_.target(map_.next(h)), d = map_.target(map_.next(t));
  const Jump cd = lattice_.flipped_jump(h), dc = reversed(cd, posy);
  const Jump bc = lattice_.jump(map_.next(h)), ca = lattice_.jump(map_.prev(h));
  const Jump ad = lattice_.jump(map_.next(t)), db = lattice_.jump(map_.prev(t));
  return {{{{a, d, c}, {posy, {ad, dc, ca}}}, {{d, b, c}, {posy, {db, bc, cd}}}}};
}

std::array<LatticePiece, 2> LatticePieces::swung(Index h) const {
  const Jump back = the_other_way(h);
  std::array<LatticePiece, 2> result{piece(h), piece(PolygonMap::twin(h))};
  result[0].lattice.around[0] = reversed(back, lattice_.posy);
  result[1].lattice.around[0] = back;
  return result;
}

LatticePiece LatticePieces::shifted(LatticePiece piece, const std::array<int, 2>& t) const {
  auto& [away, beyond, back] = piece.lattice.around;
  const auto returned = rotate_jump(t, lattice_.posy - back.rotation, lattice_.posy);
  away.t = {away.t[0] - t[0], away.t[1] - t[1]};
  back.t = {back.t[0] + returned[0], back.t[1] + returned[1]};
  return piece;
}

void LatticePieces::collapsed(Index h, std::vector<LatticePiece>& pieces) const {
  const Index t = PolygonMap::twin(h), a = map_.origin(h);
  const int posy = lattice_.posy;
  const Jump ab = lattice_.jump(h), ba = reversed(ab, posy);
  pieces.clear();
  for (Index g = map_.around(t); g != t; g = map_.around(g)) {
    if (lattice_.holes[g]) continue;
    LatticePiece moved = piece(g);
    if (moved.corners[1] == a || moved.corners[2] == a) continue;
    moved.corners[0] = a;
    auto& around = moved.lattice.around;
    around[0] = composed(ab, around[0], posy);
    around[2] = composed(around[2], ba, posy);
    pieces.push_back(moved);
  }
}

bool LatticePieces::keep_angles(std::span<const LatticePiece> before,
                                std::span<const LatticePiece> after, Index gone) {
  changes_.clear();
  const auto add = [&](const LatticePiece& piece, double sign) {
    for (int k = 0; k < 3; ++k) {
      const Index v = piece.corners[k];
      auto it = std::find_if(changes_.begin(), changes_.end(),
                             [&](const Change& change) { return change.vertex == v; });
      if (it == changes_.end()) it = changes_.insert(it, {v, 0});
      it->angle += sign * piece.lattice.angle(k);
    }
  };
  for (const LatticePiece& piece : before) add(piece, -1);
  for (const LatticePiece& piece : after) add(piece, 1);
  constexpr double tolerance = 1e-3;
  return std::all_of(changes_.begin(), changes_.end(), [&](const Change& change) {
    const Index v = change.vertex;
    if (v == gone || v == no_index || std::abs(change.angle) < tolerance) return true;
    if (lattice_.clusters.on_border[v] || lattice_.hold[v] == at_corner) return true;
    const double angle = lattice_.total_angle(v) + change.angle;
    return std::abs(angle - full_angle(v, after)) < tolerance;
  });
}

}  // namespace meshgrain
