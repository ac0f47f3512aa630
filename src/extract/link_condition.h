#pragma once

#include <vector>

#include "extract/polygon_map.h"

namespace meshgrain {

/// Whether an edge between triangles may be contracted without a change of topology (Dey et al.
/// 1999), with every hole counted as one more vertex that is joined to all of its rim.
class LinkCondition {
 public:
  bool holds(const PolygonMap& map, const std::vector<std::uint8_t>& holes, Index h) {
    stamp_.resize(map.vertices(), 0);
    const Index t = PolygonMap::twin(h);
    const bool rim_edge = holes[h] || holes[t];
    ++round_;
    const Star a = visit(map, holes, h, [&](Index v) {
      stamp_[v] = round_;
      return false;
    });
    // Around a narrow neck there may be another edge between the two, which would become a loop;
    // or both triangles beside it may have one apex, and be all that is around one of the two.
    const Index origin = map.origin(h);
    std::size_t between = 0;
    Index apex = no_index;
    bool have_one_apex = false;
    const Star b = visit(map, holes, t, [&](Index v) {
      between += v == origin;
      const bool is_common = stamp_[v] == round_;
      have_one_apex = have_one_apex || (is_common && v == apex);
      if (is_common) apex = v;
      return is_common;
    });
    if (between > 1 || have_one_apex) return false;
    if (b.common != (rim_edge ? 1u : 2u)) return false;
    if (a.rim && b.rim && !rim_edge) return false;
    return a.valence + a.rim > 3 || b.valence + b.rim > 3;
  }

 private:
  struct Star {
    std::size_t valence = 0, common = 0;
    bool rim = false;
  };

  template <typename IsCommon>
  static Star visit(const PolygonMap& map, const std::vector<std::uint8_t>& holes, Index start,
                    const IsCommon& is_common) {
    Star star;
    Index g = start;
    do {
      ++star.valence;
      star.rim = star.rim || holes[g];
      star.common += is_common(map.target(g));
      g = map.around(g);
    } while (g != start);
    return star;
  }

  std::vector<Index> stamp_;  // the round in which a vertex was last seen
  Index round_ = 0;
};

}  // namespace meshgrain
