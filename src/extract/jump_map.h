#pragma once

#include <cstdint>
#include <vector>

#include "extract/link_condition.h"
#include "extract/polygon_map.h"
#include "features/feature_edges.h"
#include "field/jumps.h"

namespace meshgrain {

/// Triangles with an integer jump on every edge: what a position field says about a surface. The
/// jumps around a triangle add up to nothing, except where it holds a singularity.
struct JumpMap {
  int posy = 4;
  PolygonMap map;
  std::vector<std::uint8_t> holes;  // for each halfedge, whether it lies outside
  std::vector<Jump> jumps;          // of each edge, in the frame of its even halfedge's origin
  std::vector<Index> lines;         // the feature line that each edge is part of, or no_index
  std::vector<std::uint8_t> hold;   // of each vertex: Hold
  // Of each line, whether its jumps stay as they are, so that it gets the same vertices on all
  // sides of a cut. Empty: none do.
  std::vector<std::uint8_t> line_stays;

  Jump jump(Index h) const {
    const Jump& stored = jumps[h / 2];
    return h % 2 == 0 ? stored : reversed(stored, posy);
  }
  void set_jump(Index h, const Jump& jump) {
    jumps[h / 2] = h % 2 == 0 ? jump : reversed(jump, posy);
  }

  /// The jumps around the triangle left of h, added up in the frame of h's origin: a rotation if it
  /// holds a singularity of the orientation field, else the Burgers vector of its position
  /// singularity.
  Jump sum(Index h) const {
    const Index g = map.next(h);
    return composed(composed(jump(h), jump(g), posy), jump(map.next(g)), posy);
  }

  template <typename Body>
  void for_each_leaving(Index v, const Body& body) const {
    map.for_each_leaving(v, body);
  }

  bool on_feature(Index h) const { return lines[h / 2] != no_index; }
  bool is_kept(Index h) const {
    return !line_stays.empty() && on_feature(h) && line_stays[lines[h / 2]] != 0;
  }

  /// Whether h may be contracted, its target vanishing, as far as features are concerned: corners
  /// stay, lines shrink only along themselves, those that stay only where nothing is lost, and no
  /// two edges of lines become one.
  bool keeps_features(Index h) const {
    if (hold[map.target(h)] == free_vertex) return true;
    if (hold[map.target(h)] == at_corner || !on_feature(h)) return false;
    if (is_kept(h) && !jump(h).is_zero()) return false;
    const auto is_between_lines = [&](Index side) {
      return !holes[side] && on_feature(map.next(side)) && on_feature(map.prev(side));
    };
    return !is_between_lines(h) && !is_between_lines(PolygonMap::twin(h));
  }

  /// Contracts h, whose target vanishes; the edges that left it now leave its origin. The triangles
  /// on both sides lose two edges to one: `is_better(from, to, a, b)` says whether jump a rather
  /// than jump b should stay between two vertices where they disagree, as they do if the triangle
  /// is singular.
  template <typename IsBetter>
  void collapse(Index h, const IsBetter& is_better) {
    const Index t = PolygonMap::twin(h), a = map.origin(h), b = map.origin(t);
    const Jump ab = jump(h);
    for_each_leaving(b, [&](Index g) {
      if (g != t) set_jump(g, composed(ab, jump(g), posy));
    });
    const Index next_h = map.next(h), prev_h = map.prev(h);
    const Index next_t = map.next(t), prev_t = map.prev(t);
    const bool left = !holes[h], right = !holes[t];
    struct Zip {
      Index gone, kept;
    };
    // Halfedges of the two edges, inside the triangle that vanishes.
    const auto choose = [&](Index from_b, Index from_a, Index apex) -> Zip {
      const Jump of_b = map.origin(from_b) == b ? jump(from_b) : jump(PolygonMap::twin(from_b));
      const Jump of_a = map.origin(from_a) == a ? jump(from_a) : jump(PolygonMap::twin(from_a));
      const bool b_better =
          !on_feature(from_a) && of_a.t != of_b.t && is_better(a, apex, of_b, of_a);
      return b_better ? Zip{from_a, from_b} : Zip{from_b, from_a};
    };
    Zip zips[2];
    int count = 0;
    if (left) zips[count++] = choose(next_h, prev_h, map.target(next_h));
    if (right) zips[count++] = choose(prev_t, next_t, map.target(next_t));
    map.contract_edge(h);
    for (int k = 0; k < count; ++k) {
      holes[zips[k].kept] = holes[PolygonMap::twin(zips[k].gone)];
      if (on_feature(zips[k].gone)) lines[zips[k].kept / 2] = lines[zips[k].gone / 2];
      map.remove_edge(zips[k].gone);
    }
  }
};

}  // namespace meshgrain
