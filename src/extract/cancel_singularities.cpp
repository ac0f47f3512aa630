#include "extract/cancel_singularities.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstdint>
#include <queue>
#include <tuple>
#include <vector>

#include "extract/path_search.h"
#include "extract/unit_carrier.h"

namespace meshgrain {
namespace {

/// Takes the cheapest path of all, then the cheapest of those that are left, and so on.
class Cancelling {
 public:
  Cancelling(LatticeMesh& lattice, double cost, const Context& context)
      : lattice_(lattice),
        context_(context),
        carrier_(lattice),
        searches_([this, cost] { return PathSearch(carrier_, cost); }),
        changed_(PathSearch::region(static_cast<Index>(lattice.map.halfedges())) + 1, 0) {}

  void run() {
    for (Index h = 0; h < lattice_.map.halfedges(); ++h) {
      if (lattice_.stands_for_triangle(h) && is_singular(h)) starts_.push_back({.h = h});
    }
    std::vector<Index> all(starts_.size());
    for (Index k = 0; k < starts_.size(); ++k) {
      all[k] = k;
      queue_.push({0, k});
    }
    look(all);
    // The cost that a start is queued with is a lower bound until its path has been looked for
    // again.
    while (!queue_.empty()) {
      const Place place = queue_.top();
      queue_.pop();
      Start& start = starts_[place.start];
      if (!is_singular(start.h)) continue;
      if (is_old(start)) look_ahead(place.start);
      if (start.path.steps.empty()) continue;
      if (start.path.cost > place.cost + 1e-6) {
        queue_.push({start.path.cost, place.start});
        continue;
      }
      follow(start.path);
      queue_.push({0, place.start});  // if anything is left
    }
  }

 private:
  struct Start {
    Index h;
    std::uint32_t found = 0;  // the time when the path was
    PathSearch::Path path{};
  };
  struct Place {
    double cost;
    Index start;
    bool operator<(const Place& o) const {
      return std::tie(cost, start) > std::tie(o.cost, o.start);
    }
  };

  bool is_singular(Index h) const {
    const LatticeTriangle triangle = lattice_.triangle(h);
    return !triangle.is_cone() && !triangle.is_plane();
  }

  /// Whether a search could find something else by now.
  bool is_old(const Start& start) const {
    return std::ranges::any_of(
        start.path.regions, [&](std::uint32_t region) { return changed_[region] > start.found; });
  }

  void look(const std::vector<Index>& starts) {
    context_.for_ranges(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        Start& start = starts_[starts[k]];
        start.path = searches_.local().from(start.h);
        start.found = now_;
      }
    });
  }

  /// Together with the next ones, which will most likely be asked for as they are now.
  void look_ahead(Index first) {
    const auto threads = static_cast<std::size_t>(context_.threads());
    std::vector<Index> old{first};
    std::vector<Place> passed;
    while (old.size() < threads && passed.size() < 4 * threads && !queue_.empty()) {
      const Place place = queue_.top();
      queue_.pop();
      const Start& start = starts_[place.start];
      if (!is_singular(start.h)) continue;
      passed.push_back(place);
      if (is_old(start)) old.push_back(place.start);
    }
    for (const Place& place : passed) queue_.push(place);
    look(old);
  }

  void follow(const PathSearch::Path& path) {
    ++now_;
    for (const UnitCarrier::State& step : path.steps) {
      lattice_.set_jump(step.h, carrier_.left(step));
      look_again(step.h);
      look_again(PolygonMap::twin(step.h));
    }
  }
  void look_again(Index h) {
    carrier_.look_again(h);
    if (lattice_.holes[h]) return;
    for (int corner = 0; corner < 3; ++corner, h = lattice_.map.next(h)) {
      changed_[PathSearch::region(h)] = now_;
    }
  }

  LatticeMesh& lattice_;
  const Context& context_;
  UnitCarrier carrier_;
  tbb::enumerable_thread_specific<PathSearch> searches_;
  std::vector<Start> starts_;
  std::priority_queue<Place> queue_;
  std::uint32_t now_ = 0;               // the number of paths that were followed
  std::vector<std::uint32_t> changed_;  // of each region: when it last did
};

}  // namespace

void cancel_position_singularities(LatticeMesh& lattice, double cost, const Context& context) {
  if (cost > 0) Cancelling(lattice, cost, context).run();
}

}  // namespace meshgrain
