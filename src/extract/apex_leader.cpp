#include "extract/apex_leader.h"

#include <algorithm>

namespace meshgrain {

bool ApexLeader::lead(Index from, Index to) {
  constexpr int most_swings = 3;
  changed_.clear();
  remade_.clear();
  return search(map_.halfedge(from, to), most_swings, 0, false);
}

/// The apex of the cone left of h, but not back over h if it came over that. `flaws_so_far`: by how
/// much there are more by now.
bool ApexLeader::search(Index h, int swings, double flaws_so_far, bool came_over_h) {
  constexpr double least_better = 0.5, most_more = 2;
  const double enough = -least_better - flaws_so_far;
  const double most = swings > 1 ? most_more - flaws_so_far : enough;
  std::vector<Lead> leads;
  if (!came_over_h) find_over(h, most, leads);
  find_over(map_.next(h), most, leads);
  find_over(map_.prev(h), most, leads);
  std::ranges::sort(leads, {}, &Lead::cost);
  for (const Lead& lead : leads) {
    const Index over = halfedge(lead.over), t = PolygonMap::twin(over);
    const bool has_flip = lead.flipped != no_edge;
    const Index flipped = has_flip ? halfedge(lead.flipped) : over;
    // An input with two edges between the same vertices may have hidden the one that was meant.
    if (has_flip && !lattice_.may_flip(flipped)) continue;
    const std::array<Index, 4> here = pieces_.corners(over), beyond = pieces_.corners(flipped);
    const Jump before = lattice_.jump(t), back = pieces_.the_other_way(over);
    if (has_flip) lattice_.flip(flipped);
    lattice_.set_jump(t, back);
    if (lead.flaws <= enough || search(t, swings - 1, flaws_so_far + lead.flaws, true)) {
      changed_.push_back(here);
      changed_.push_back(beyond);
      return true;
    }
    lattice_.set_jump(t, before);
    if (has_flip) {
      lattice_.flip(map_.halfedge(beyond[2], beyond[3]));
      remade_.push_back(halfedge(lead.flipped));
    }
  }
  return false;
}

void ApexLeader::find_over(Index over, double most_flaws, std::vector<Lead>& leads) {
  const Index t = PolygonMap::twin(over);
  if (lattice_.holes[t] || !lattice_.triangle(t).is_plane()) return;
  const Jump back = pieces_.the_other_way(over);
  if (lattice_.spoils_line(over, back.t)) return;
  const LatticeMetric metric = lattice_.metric();
  const LatticePiece cone = pieces_.piece(over), next = pieces_.piece(t);
  const auto [left, entered] = pieces_.swung(over);
  const double longer = metric.squared_length(back.t) - lattice_.squared_length(over);

  // `then_cone`: among `after`.
  const auto add = [&](Index flip, std::span<const LatticePiece> before,
                       std::span<const LatticePiece> after, const LatticePiece& then_cone) {
    const double more = flaws(after) - flaws(before);
    if (more > most_flaws) return;
    // On the border angles are free, and it would come to go astray.
    const auto at_border = [&](Index v) { return lattice_.clusters.on_border[v] != 0; };
    const auto touches_border = [&](const LatticePiece& piece) {
      return std::ranges::any_of(piece.corners, at_border);
    };
    if (std::ranges::any_of(before, touches_border) || !pieces_.keep_angles(before, after)) return;
    double away = 0;  // squared, of the corners from the apex
    for (int k = 0; k < 3; ++k) away += metric.squared_length(then_cone.lattice.apex(k));
    const double shorter = flip != no_index ? pieces_.shortening(flip) : 0;
    const double cost = 4 * more + longer - shorter + 0.3 * away;
    leads.push_back({ends(over), flip != no_index ? ends(flip) : no_edge, more, cost});
  };
  add(no_index, std::array{cone, next}, std::array{left, entered}, entered);
  for (const Index e : {map_.next(t), map_.prev(t)}) {
    const Index beyond = PolygonMap::twin(e);
    if (!lattice_.may_flip(e) || !lattice_.triangle(beyond).is_plane()) continue;
    auto [by_origin, by_target] = pieces_.flipped(e);
    // The edge of t is the last of the one triangle or the second of the other.
    const bool is_by_origin = e == map_.next(t);
    (is_by_origin ? by_origin.lattice.around[2] : by_target.lattice.around[1]) = back;
    add(e, std::array{cone, next, pieces_.piece(beyond)}, std::array{left, by_origin, by_target},
        is_by_origin ? by_origin : by_target);
  }
}

}  // namespace meshgrain
