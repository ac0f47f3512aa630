#include "extract/cancel_singularities.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "extract/unit_carrier.h"
#include "extract/unit_waves.h"

namespace meshgrain {
namespace {

constexpr int most_to_vanish = 2;  // irregular vertices, at one end

/// Takes the cheapest way of all, then the cheapest of those that are left, and so on.
class Cancelling {
 public:
  Cancelling(LatticeMesh& lattice, UnitCarrier& carrier, UnitWaves& waves,
             const CancellingCost& most, const Context& context)
      : lattice_(lattice), carrier_(carrier), waves_(waves), most_(most), context_(context) {}

  /// All within a piece, as if there were nothing beyond its border.
  void run_within(const UnitWaves::Piece& piece) {
    for (std::uint32_t t = piece.begin; t < piece.end; ++t) {
      const Index h = carrier_.halfedge({4 * t, 0});
      if (lattice_.stands_for_triangle(h) && is_singular(h)) waves_.start(h);
    }
    // What is cheap goes before waves have come far: they need not grow over it again.
    constexpr float first_reach = 2, wider = 1.3f;
    for (float reach = first_reach;; reach *= wider) {
      waves_.set_reach(reach);
      find_meetings();
      const bool is_last = waves_.are_grown();
      take_ways(is_last ? UnitWaves::never : reach);
      if (is_last && waves_.are_grown()) return;
    }
  }

  /// What is left, where waves have grown already.
  void run_on() {
    find_meetings();
    take_ways(UnitWaves::never);
  }

 private:
  /// Those that cost less than one by a way that is not known yet: by more than twice `unknown`, at
  /// both ends together.
  void take_ways(float unknown) {
    while (!queue_.empty() && queue_.top().cost < unknown / most_to_vanish) {
      const UnitWaves::Meeting meeting = queue_.top().meeting;
      queue_.pop();
      if (const auto ends = waves_.ends(meeting)) {
        if (follow(meeting)) start_again(*ends);
      } else {
        waves_.meet_again(meeting);
      }
      context_.check();
      find_meetings();
    }
  }

  struct Place {
    double cost;
    UnitWaves::Meeting meeting;
    bool operator<(const Place& o) const {
      const auto key = [](const Place& p) {
        return std::tuple(p.cost, p.meeting.here, p.meeting.there);
      };
      return key(*this) > key(o);
    }
  };

  bool is_singular(Index h) const {
    const LatticeTriangle triangle = lattice_.triangle(h);
    return !triangle.is_cone() && !triangle.is_plane();
  }

  /// A singularity costs two irregular vertices. At the end of the way another may vanish as well,
  /// so that a longer one can be the cheaper one for each of them.
  double cost_for_each(const UnitWaves::Meeting& meeting, const UnitWaves::Ends& ends) const {
    const int gone = carrier_.loss(ends.from) + (ends.to != no_index ? carrier_.loss(ends.to) : 0);
    return double{meeting.cost} / gone;
  }

  double most_for(const UnitWaves::Ends& ends) const {
    const auto any = [&](auto is) { return is(ends.from) || (ends.to != no_index && is(ends.to)); };
    if (any([&](Index h) { return lattice_.keeps_singularity(h); })) return 0;
    const bool graded = any([&](Index h) { return lattice_.is_graded(h); });
    return graded ? most_.where_graded : most_.usual;
  }

  void start_again(const UnitWaves::Ends& ends) {
    for (const Index h : {ends.from, ends.to}) {
      if (h == no_index) continue;
      waves_.take_back(h);
      if (is_singular(h)) waves_.start(h);  // if anything is left
    }
  }

  void find_meetings() {
    std::vector<UnitWaves::Meeting> meetings;
    do {
      meetings.clear();
      waves_.grow(meetings, context_);
      for (const UnitWaves::Meeting& meeting : meetings) {
        const auto ends = waves_.ends(meeting);
        if (!ends) {
          waves_.meet_again(meeting);
          continue;
        }
        const double cost = cost_for_each(meeting, *ends);
        if (cost < most_for(*ends)) queue_.push({cost, meeting});
      }
    } while (!meetings.empty());
  }

  /// Returns false if that cannot be done, and nothing has.
  bool follow(const UnitWaves::Meeting& meeting) {
    std::vector<UnitCarrier::State> steps = waves_.way(meeting.here);
    if (steps.empty()) return false;
    if (meeting.there != no_index) {
      const std::vector<UnitCarrier::State> others = waves_.way(meeting.there);
      if (others.empty()) return false;
      steps.insert(steps.end(), others.begin() + 1, others.end());  // the first is the same edge
    }
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (!carrier_.may_leave(steps[k])) {
        while (k-- > 0) carry(carrier_.opposite(steps[k]));
        return false;
      }
      carry(steps[k]);
    }
    look_again(carrier_, steps);
    look_again(waves_, steps);
    return true;
  }
  template <typename Observer>
  void look_again(Observer& observer, const std::vector<UnitCarrier::State>& changed) const {
    for (const UnitCarrier::State& step : changed) {
      const Index h = carrier_.halfedge(step);
      for (const Index side : {h, PolygonMap::twin(h)}) {
        if (!lattice_.holes[side]) observer.look_again(side);
      }
    }
  }
  void carry(const UnitCarrier::State& step) {
    lattice_.set_jump(carrier_.halfedge(step), carrier_.left(step));
  }

  LatticeMesh& lattice_;
  UnitCarrier& carrier_;
  UnitWaves& waves_;
  CancellingCost most_;
  const Context& context_;
  std::priority_queue<Place> queue_;
};

/// Triangles that follow each other lie together. A step costs about one, so that a piece is some
/// times as wide as waves come far, and few reach its border. There are 1, 2, 4 or so on, to be
/// joined two by two.
std::vector<UnitWaves::Piece> cut(std::size_t triangles, double radius, std::size_t at_once) {
  constexpr double widths = 3;
  const double least = std::max(static_cast<double>(at_once), std::pow(widths * radius, 2));
  const auto count = std::bit_ceil(
      static_cast<std::size_t>(std::max(1.0, static_cast<double>(triangles) / least)));
  const auto begin = [&](std::size_t k) {
    return static_cast<std::uint32_t>(triangles * k / count);
  };
  std::vector<UnitWaves::Piece> pieces;
  for (std::size_t k = 0; k < count; ++k) pieces.push_back({begin(k), begin(k + 1)});
  return pieces;
}

/// Two pieces each as one. To join all at once would leave the ways over their borders to a single
/// thread.
std::vector<UnitWaves> joined(std::vector<UnitWaves>&& pieces, const Context& context) {
  std::vector<UnitWaves> result;
  for (std::size_t k = 0; k < pieces.size(); k += 2) {
    result.emplace_back(std::span(pieces).subspan(k, 2), context);
  }
  return result;
}

}  // namespace

void cancel_position_singularities(LatticeMesh& lattice, const CancellingCost& most,
                                   const Context& context, std::size_t at_once) {
  const double radius = most_to_vanish * std::max(most.usual, most.where_graded);
  if (!(radius > 0)) return;
  UnitCarrier carrier(lattice, context);
  const std::vector<UnitWaves::Piece> pieces = cut(carrier.triangles(), radius, at_once);
  std::vector<UnitWaves::Label> labels(carrier.states());
  std::vector<UnitWaves> waves;
  for (const auto& piece : pieces) waves.emplace_back(carrier, radius, labels, piece);
  context.for_ranges(pieces.size(), 1, [&](std::size_t k, std::size_t) {
    Cancelling(lattice, carrier, waves[k], most, context).run_within(pieces[k]);
  });
  while (waves.size() > 1) {
    waves = joined(std::move(waves), context);
    context.for_ranges(waves.size(), 1, [&](std::size_t k, std::size_t) {
      Cancelling(lattice, carrier, waves[k], most, context).run_on();
    });
  }
}

}  // namespace meshgrain
