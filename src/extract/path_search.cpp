#include "extract/path_search.h"

#include <utility>

namespace meshgrain {

PathSearch::PathSearch(const UnitCarrier& carrier, double most)
    : carrier_(carrier),
      most_(most),
      visits_(carrier.states()),
      last_search_(region(static_cast<Index>(carrier.halfedges())) + 1, 0) {}

void PathSearch::visit(float cost, const State& to, Origin origin) {
  if (!(cost < bound_)) return;
  const std::uint32_t number = carrier_.number(to);
  Visit& visit = visits_[number];
  if (visit.when >= 4 * search_ && visit.cost <= cost) return;
  visit = {cost, 4 * search_ + origin};
  queue_.push(cost, number);
}

PathSearch::Path PathSearch::from(Index start) {
  ++search_;
  queue_.clear();
  // A singularity costs two irregular vertices. At the end of the path another may vanish as well,
  // so that a longer path can be the cheaper one for each of them.
  const int here = carrier_.loss(start);
  Path best;
  best.cost = most_;
  bound_ = best.cost * (here + 2);
  const auto note = [&](Index h) {
    const std::uint32_t place = region(h);
    if (std::exchange(last_search_[place], search_) != search_) best.regions.push_back(place);
  };
  for (int unit = 0; unit < carrier_.units(); ++unit) {
    State out{start, unit};
    if (!carrier_.shortens(out)) continue;
    for (int side = 0; side < 3; ++side, out = carrier_.along(out)) {
      note(out.h);
      visit(carrier_.leaving(out), carrier_.across(out), nowhere);
    }
  }
  const auto is_start = [&, second = carrier_.along({start, 0}).h,
                         third = carrier_.back({start, 0}).h](Index h) {
    return h == start || h == second || h == third;
  };
  std::uint32_t last = no_index;
  while (queue_.find() && queue_.least() < bound_) {
    const auto [cost, number] = queue_.pop();
    if (cost > visits_[number].cost || cost >= bound_) continue;
    const State in = carrier_.state(number);
    note(in.h);
    if (is_start(in.h)) continue;
    const std::optional<int> there = carrier_.gain(in);
    if (there) {
      const double each = (cost + double{carrier_.ending(in)}) / (here + *there);
      if (each >= best.cost) continue;
      best.cost = each;
      bound_ = each * (here + 2);
      last = number;
      continue;
    }
    State out = in;
    for (int side = 0; side < 2; ++side) {
      out = carrier_.along(out);
      visit(cost + carrier_.passing(in, side), carrier_.across(out),
            side == 0 ? previous_edge : edge_before);
    }
  }
  while (last != no_index) {
    const State out = carrier_.across(carrier_.state(last));
    best.steps.push_back(out);
    const auto origin = static_cast<Origin>(visits_[last].when % 4);
    if (origin == nowhere) break;
    State in = carrier_.back(out);
    if (origin == edge_before) in = carrier_.back(in);
    last = carrier_.number(in);
  }
  return best;
}

}  // namespace meshgrain
