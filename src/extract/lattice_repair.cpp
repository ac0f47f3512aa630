#include "extract/lattice_repair.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "extract/apex_leader.h"
#include "extract/free_points.h"
#include "extract/lattice_pieces.h"
#include "util/collect.h"
#include "util/edge_of.h"
#include "util/index_marks.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

constexpr double least_gain = 1e-6;

using Piece = LatticePiece;

class LatticeRepair {
 public:
  LatticeRepair(LatticeMesh& lattice, const Context& context)
      : lattice_(lattice), map_(lattice.map), changed_(map_.vertices(), 0) {
    mark_all(context);
  }

  void run() {
    // Each kind of change lowers what it looks at; the bound is for those that work against each
    // other.
    constexpr int rounds = 30;
    for (int round = 0; round < rounds; ++round) {
      bool changed = collapse_zero_edges();
      changed = flip_edges() || changed;
      changed = swing_edges() || changed;
      // Leads come last: flips may bring their apexes back, and nothing else would have a turn.
      changed = changed || unfold_lines() || shift_vertices() || collapse_flawed() || fill_in() ||
                lead_apexes();
      if (!changed) return;
    }
  }

 private:
  /// What the first round must look at, found in parallel: most of a lattice is whole.
  void mark_all(const Context& context) {
    const std::vector<std::uint8_t> whole = mark_triangles(context);
    const auto edges = static_cast<Index>(map_.halfedges() / 2);
    const auto mark_if = [&](IndexMarks& marks, const auto& condition) {
      for (const Index e : indices_where(edges, condition, context)) marks.set(e);
    };
    mark_if(zero_edges_, [&](Index e) { return lattice_.jumps[e].is_zero(); });
    mark_if(long_edges_, [&](Index e) { return parts(2 * e) > 1; });
    mark_if(flips_, [&](Index e) {
      const Index h = 2 * e, t = h + 1;
      if (map_.removed(h) || lattice_.holes[h] || lattice_.holes[t]) return false;
      if (whole[h] && whole[t]) return pieces_.shortening(h) >= least_gain;
      return flip_gains(h).most() >= least_gain;
    });
  }

  /// Of each halfedge, whether the triangle left of it is plane and has no flaw.
  std::vector<std::uint8_t> mark_triangles(const Context& context) {
    std::vector<std::uint8_t> whole(map_.halfedges(), 0);
    struct Found {
      Index h;
      bool is_cone, is_flawed, may_have_free_point;
    };
    const auto look = [&](std::size_t begin, std::size_t end, std::vector<Found>& out) {
      for (auto h = static_cast<Index>(begin); h < end; ++h) {
        if (!lattice_.stands_for_triangle(h)) continue;
        const LatticeTriangle triangle = lattice_.triangle(h);
        const Found found{h, triangle.is_cone(), triangle.flaw() > 0,
                          may_have_free_point(triangle)};
        if (found.is_cone || found.is_flawed || found.may_have_free_point) out.push_back(found);
        if (triangle.is_plane() && !found.is_flawed) {
          whole[h] = whole[map_.next(h)] = whole[map_.prev(h)] = 1;
        }
      }
    };
    for (const Found& found : collect<Found>(map_.halfedges(), look, context)) {
      if (found.may_have_free_point) large_.set(found.h);
      Index h = found.h;
      for (int k = 0; k < 3; ++k, h = map_.next(h)) {
        if (found.is_cone) swings_.set(h);
        if (found.is_flawed) unsound_.set(map_.origin(h));
      }
    }
    return whole;
  }

  /// For every kind of change: what was refused before would be refused again, unless something has
  /// changed in the stars of the corners beside the edge.
  void mark(Index edge) {
    zero_edges_.set(edge);
    flips_.set(edge);
    long_edges_.set(edge);
    for (const Index h : {2 * edge, 2 * edge + 1}) {
      swings_.set(h);
      large_.set(h);
    }
  }
  void mark_star(Index v) {
    changed_[v] = now_;
    unsound_.set(v);
    lattice_.for_each_leaving(v, [&](Index h) {
      mark(h / 2);
      mark(map_.next(h) / 2);
    });
  }
  void touch(std::span<const Index> vertices) {
    ++now_;
    for (const Index v : vertices) mark_star(v);
  }
  void touch_star(Index v) {
    changed_.resize(map_.vertices(), 0);
    ++now_;
    mark_star(v);
    lattice_.for_each_leaving(v, [&](Index h) { mark_star(map_.target(h)); });
  }

  void star(Index v, std::vector<Piece>& pieces) const {
    pieces.clear();
    lattice_.for_each_leaving(v, [&](Index h) {
      if (!lattice_.holes[h]) pieces.push_back(pieces_.piece(h));
    });
  }

  /// Whether no triangle around v is flawed; if one is, `before_` gets them all.
  bool is_sound(Index v) {
    star(v, before_);
    if (flaws(before_) > 0) return false;
    unsound_.clear(v);
    return true;
  }

  /// Vertices that a kind of change was refused to: it would be again until something has changed.
  class Refused {
   public:
    void set(Index v, std::uint32_t now) {
      if (v >= since_.size()) since_.resize(v + 1 + v / 8, 0);
      since_[v] = now + 1;
    }
    bool still(Index v, const LatticeRepair& repair) const {
      return v < since_.size() && since_[v] > 0 && !repair.has_changed(v, since_[v] - 1);
    }

   private:
    std::vector<std::uint32_t> since_;
  };

  /// Whether anything has changed, after the change `since`, that a change at v could look at.
  bool has_changed(Index v, std::uint32_t since) const {
    if (changed_[v] > since) return true;
    bool any = false;
    lattice_.for_each_leaving(v, [&](Index h) { any = any || changed_[map_.target(h)] > since; });
    return any;
  }

  bool collapse_zero_edges() {
    bool any = false;
    for (bool again = true; again;) {
      again = false;
      const auto count = static_cast<Index>(map_.halfedges() / 2);
      for (Index e = zero_edges_.take(0, count); e != no_index;
           e = zero_edges_.take(e + 1, count)) {
        const Index h = 2 * e;
        if (map_.removed(h) || !lattice_.jumps[e].is_zero()) continue;
        // Whoever is held more stays, else who covers more of the surface.
        const Index a = map_.origin(h), b = map_.target(h);
        const auto& [cover, hold] = std::tie(lattice_.clusters.cover, lattice_.hold);
        const bool stays = hold[a] != hold[b] ? hold[a] > hold[b] : cover[a] >= cover[b];
        const Index into = stays ? h : PolygonMap::twin(h);
        if (!lattice_.may_collapse(into)) continue;
        lattice_.collapse_edge(into);
        touch_star(stays ? a : b);
        again = any = true;
      }
    }
    return any;
  }

  bool flip_edges() {
    bool any = false;
    for (bool again = true; again;) {
      again = false;
      const auto count = static_cast<Index>(map_.halfedges() / 2);  // new ones wait
      for (Index e = flips_.take(0, count); e != no_index; e = flips_.take(e + 1, count)) {
        const Index h = 2 * e;
        if (map_.removed(h) || lattice_.holes[h] || lattice_.holes[h + 1]) continue;
        // The new edge may take its jump by way of either end of the old one.
        const FlipGains gains = flip_gains(h);
        if (gains.most() < least_gain || !lattice_.may_flip(h)) continue;
        const Index better = gains.by_origin >= gains.by_target ? h : h + 1;
        for (const Index side : {better, PolygonMap::twin(better)}) {
          const double gain = side == h ? gains.by_origin : gains.by_target;
          if (gain < least_gain || !flip_keeps_angles(side)) continue;
          const std::array<Index, 4> around = pieces_.corners(side);
          lattice_.flip(side);
          touch(around);
          again = any = true;
          break;
        }
      }
    }
    return any;
  }

  /// What is gained by flip(h) and by flip() of its twin.
  struct FlipGains {
    double by_origin = -1, by_target = -1;
    double most() const { return std::max(by_origin, by_target); }
  };

  FlipGains flip_gains(Index h) const {
    const Index t = PolygonMap::twin(h);
    const LatticeTriangle left = lattice_.triangle(h), right = lattice_.triangle(t);
    const int turn = left.sum().rotation, other_turn = right.sum().rotation;
    // Two singularities in one triangle would be one of higher index.
    if (turn != 0 && other_turn != 0 && turn + other_turn != lattice_.posy) return {};
    const double before = left.flaw() + right.flaw();
    const auto gain = [&](Index side) {
      const double most = before + pieces_.shortening(side);
      // Most edges are short and between sound triangles: no need to look at those that would be.
      return most < least_gain ? most : most - flaws(pieces_.flipped(side));
    };
    return {gain(h), gain(t)};
  }

  bool flip_keeps_angles(Index h) {
    const std::array<Piece, 2> before{pieces_.piece(h), pieces_.piece(PolygonMap::twin(h))};
    return pieces_.keep_angles(before, pieces_.flipped(h));
  }

  /// An edge of a cone may pass the apex on either side. Gives it the jump by way of the other two
  /// edges where that is better; the apex is then in the triangle beyond.
  bool swing_edges() {
    bool any = false;
    const auto count = static_cast<Index>(map_.halfedges());
    for (Index h = swings_.take(0, count); h != no_index; h = swings_.take(h + 1, count)) {
      const Index t = PolygonMap::twin(h);
      if (map_.removed(h) || lattice_.holes[h] || lattice_.holes[t]) continue;
      if (!lattice_.triangle(h).is_cone() || lattice_.triangle(t).is_cone()) continue;
      const std::array<Piece, 2> before{pieces_.piece(h), pieces_.piece(t)};
      const std::array<Piece, 2> after = pieces_.swung(h);
      const Jump back = after[1].lattice.around[0];
      const double gain = flaws(before) - flaws(after) + lattice_.squared_length(h) -
                          lattice_.metric().squared_length(back.t);
      if (lattice_.spoils_line(h, back.t)) continue;
      if (gain < least_gain || !pieces_.keep_angles(before, after)) continue;
      lattice_.set_jump(t, back);
      touch(pieces_.corners(h));
      any = true;
    }
    return any;
  }

  /// Of flawed cones: see ApexLeader.
  bool lead_apexes() {
    bool any = false;
    for (Index v = unsound_.first(0); v != no_index; v = unsound_.first(v + 1)) {
      if (map_.leaving(v) == no_index || lead_refused_.still(v, *this) || is_sound(v)) continue;
      if (lead_apex_at(v)) {
        any = true;
      } else {
        lead_refused_.set(v, now_);
      }
    }
    return any;
  }

  bool lead_apex_at(Index v) {
    std::vector<Index> targets;  // of edges with flawed cones on their left
    lattice_.for_each_leaving(v, [&](Index h) {
      if (lattice_.holes[h]) return;
      const LatticeTriangle triangle = lattice_.triangle(h);
      if (triangle.is_cone() && triangle.flaw() > 0) targets.push_back(map_.target(h));
    });
    return std::ranges::any_of(targets, [&](Index target) {
      const bool led = leader_.lead(v, target);
      for (const Index h : leader_.remade()) mark(h / 2);
      for (const auto& corners : leader_.changed()) touch(corners);
      return led;
    });
  }

  /// Takes vertices away where a feature line goes back the way that it came.
  bool unfold_lines() {
    bool any = false;
    for (Index v = 0; v < map_.vertices(); ++v) {
      if (map_.leaving(v) == no_index || lattice_.hold[v] != on_line) continue;
      if (lattice_.clusters.on_border[v]) continue;  // ragged ones do go to and fro
      const Index h = folded_edge(v);
      if (h == no_index || !lattice_.may_collapse(PolygonMap::twin(h))) continue;
      const Index kept = map_.target(h);
      lattice_.collapse_edge(PolygonMap::twin(h));
      touch_star(kept);
      any = true;
    }
    return any;
  }

  /// One of the two edges of a feature line that leave a vertex by the same jump, or no_index.
  Index folded_edge(Index v) const {
    Index first = no_index, folded = no_index;
    lattice_.for_each_leaving(v, [&](Index h) {
      if (!lattice_.on_feature(h)) return;
      if (first == no_index) {
        first = h;
      } else if (lattice_.jump(h).t == lattice_.jump(first).t) {
        folded = h;
      }
    });
    return folded;
  }

  /// How far the edges around a vertex are from their real length once it is shifted, squared.
  double misfit(Index v, const std::array<int, 2>& shift) const {
    double sum = 0;
    lattice_.for_each_leaving(v, [&](Index h) {
      const auto t = lattice_.jump(h).t;
      sum += lattice_.misfit(h, {t[0] - shift[0], t[1] - shift[1]});
    });
    return sum;
  }

  /// Gives vertices with flawed triangles another place in the lattice: one without flaws may still
  /// stretch edges over cells for which there is no room, which fill_in() would then crowd.
  bool shift_vertices() {
    bool any = false;
    for (Index v = unsound_.first(0); v != no_index; v = unsound_.first(v + 1)) {
      if (map_.leaving(v) == no_index || shift_refused_.still(v, *this) || is_sound(v)) continue;
      constexpr double against_stretching = 0.1;
      const double enough = flaws(before_) - least_gain;
      double least = enough + against_stretching * misfit(v, {0, 0});
      std::array<int, 2> best{0, 0};
      constexpr int reach = 2;
      for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
          after_.clear();
          for (const Piece& piece : before_) after_.push_back(pieces_.shifted(piece, {x, y}));
          const double left = flaws(after_, enough);
          if (left > enough || lattice_.shift_spoils_lines(v, {x, y})) continue;
          const double cost = left + against_stretching * misfit(v, {x, y});
          if (cost >= least || !pieces_.keep_angles(before_, after_)) continue;
          least = cost;
          best = {x, y};
        }
      }
      if (best == std::array<int, 2>{0, 0}) {
        shift_refused_.set(v, now_);
        continue;
      }
      lattice_.shift(v, best);
      touch_star(v);
      any = true;
    }
    return any;
  }

  /// Takes vertices with flawed triangles away, into the neighbour where that leaves the least.
  bool collapse_flawed() {
    bool any = false;
    for (Index v = unsound_.first(0); v != no_index; v = unsound_.first(v + 1)) {
      if (map_.leaving(v) == no_index || collapse_refused_.still(v, *this) || is_sound(v)) continue;
      double least = flaws(before_) - least_gain;
      Index best = no_index;
      lattice_.for_each_leaving(v, [&](Index g) {
        const Index into = PolygonMap::twin(g);
        if (!lattice_.may_collapse(into)) return;
        pieces_.collapsed(into, after_);
        const double left = flaws(after_, least);
        if (left >= least || !pieces_.keep_angles(before_, after_, v)) return;
        least = left;
        best = into;
      });
      if (best == no_index) {
        collapse_refused_.set(v, now_);
        continue;
      }
      const Index kept = map_.origin(best);
      lattice_.collapse_edge(best);
      touch_star(kept);
      any = true;
    }
    return any;
  }

  /// How many times as long an edge is as the way to the first lattice point on it.
  int parts(Index h) const {
    const auto t = lattice_.jump(h).t;
    return std::gcd(t[0], t[1]);
  }

  /// Puts vertices at lattice points that have none.
  bool fill_in() {
    bool any = false;
    const auto edges = static_cast<Index>(map_.halfedges() / 2);  // new ones wait
    for (Index e = long_edges_.take(0, edges); e != no_index; e = long_edges_.take(e + 1, edges)) {
      const Index h = 2 * e;
      if (map_.removed(h)) continue;
      const int count = parts(h);
      if (count < 2) continue;
      // Where the middle was flawed and went again, it would for ever.
      if (!split_.insert(edge_of(map_.origin(h), map_.target(h))).second) continue;
      const auto t = lattice_.jump(h).t;
      const int first = count / 2;
      lattice_.split(h, {t[0] / count * first, t[1] / count * first});
      touch_star(map_.target(h));
      any = true;
    }
    if (any) return true;
    const auto count = static_cast<Index>(map_.halfedges());
    for (Index h = large_.take(0, count); h != no_index; h = large_.take(h + 1, count)) {
      if (!lattice_.stands_for_triangle(h) || !may_have_free_point(lattice_.triangle(h))) continue;
      const auto point = find_free_point(lattice_, pieces_, h);
      if (!point) continue;
      lattice_.insert(point->edge, point->t, point->to_apex);
      touch_star(map_.target(map_.next(point->edge)));
      any = true;
    }
    return any;
  }

  LatticeMesh& lattice_;
  const PolygonMap& map_;
  LatticePieces pieces_{lattice_};
  ApexLeader leader_{lattice_, pieces_};
  std::vector<Piece> before_, after_;
  std::uint32_t now_ = 0;               // the number of changes so far
  std::vector<std::uint32_t> changed_;  // when each vertex's star last did
  IndexMarks zero_edges_, flips_, long_edges_;
  IndexMarks swings_, large_;  // halfedges
  IndexMarks unsound_;         // vertices with a flaw in their star, unless that went since
  Refused lead_refused_, shift_refused_, collapse_refused_;
  std::set<std::array<Index, 2>> split_;
};

}  // namespace

void repair_lattice(LatticeMesh& lattice, const Context& context) {
  LatticeRepair(lattice, context).run();
}

}  // namespace meshgrain
